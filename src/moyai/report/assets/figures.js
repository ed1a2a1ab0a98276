// Figures: each is a small table of data with drawing instructions; plotly draws it, the buttons hand the data out.
"use strict";
MOYAI.escape = (text) => String(text).replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;").replace(/\b([KC])_([TRg])(?![A-Za-z])/g, "$1<sub>$2</sub>");

MOYAI.theme = (paper) => {
  const html = document.documentElement, had = html.classList.contains("paper");
  if (paper) html.classList.add("paper");
  const s = MOYAI.style;
  const theme = { ink: s("--ink"), muted: s("--muted"), rule: s("--rule"), page: s("--page"), accent: s("--accent"), bad: s("--bad"), soft: s("--soft"), tones: s("--tones").split(/\s+/) };
  if (paper && !had) html.classList.remove("paper");
  return theme;
};

class Figure {
  constructor(element) {
    this.element = element;
    this.spec = MOYAI.data.figures[element.dataset.figure];
    this.plot = element.querySelector(".plot");
    this.abscissa = this.spec.abscissae[0];
    this.drawn = false;
    this.cache = new Map();
    const overview = element.querySelector(".overview");
    this.overview = overview ? new Overview(overview, this) : null;
    element.addEventListener("click", (event) => this.clicked(event.target.closest("button")));
  }
  values(index) {
    if (!this.cache.has(index)) this.cache.set(index, MOYAI.array(this.spec.arrays[index]));
    return this.cache.get(index);
  }
  label(axis) {
    return MOYAI.escape(axis.unit ? `${axis.label} [${MOYAI.pretty(axis.unit)}]` : axis.label);
  }
  traces(theme) {
    const bars = this.spec.categories.length > 0;
    const seen = new Set();
    return this.spec.series.filter((s) => bars || this.abscissa.key in s.x).map((s) => {
      const color = theme.tones[s.tone % theme.tones.length];
      const axis = s.panel ? "y" + (s.panel + 1) : "y";
      const trace = { name: MOYAI.escape(s.label), yaxis: axis, y: this.values(s.y), legendgroup: s.belongs_to || s.label, showlegend: !s.belongs_to && !seen.has(s.label) && s.label !== this.spec.panels[s.panel].label };
      seen.add(s.label);
      trace.hovertemplate = "%{y:.4~g}" + (this.spec.panels[s.panel].unit ? " " + MOYAI.escape(MOYAI.pretty(this.spec.panels[s.panel].unit)) : "");
      if (s.style === "bar") {
        return Object.assign(trace, { type: "bar", x: this.spec.categories.map(MOYAI.escape), marker: { color }, opacity: s.faint ? 0.45 : 1 });
      }
      const mode = { line: "lines", points: "markers", "line+points": "lines+markers" }[s.style];
      const symbols = ["circle", "square", "triangle-up", "diamond", "cross", "x", "star"];
      return Object.assign(trace, {
        type: "scatter", mode, x: this.values(s.x[this.abscissa.key]),
        line: { color, width: s.faint ? 1 : 1.8, dash: s.dash },
        marker: { color: s.style === "points" ? theme.page : color, size: s.style === "points" ? 7 : 5, symbol: symbols[s.tone % symbols.length], line: { color, width: s.style === "points" ? 1.6 : 0 } },
      });
    });
  }
  layout(theme) {
    const n = this.spec.panels.length, gap = n > 1 ? 0.045 : 0, share = (1 - gap * (n - 1)) / n;
    const axisStyle = { gridcolor: theme.rule, linecolor: theme.muted, zerolinecolor: theme.muted, zerolinewidth: 1, ticks: "outside", tickcolor: theme.muted, ticklen: 4, showline: true, mirror: true, automargin: true, exponentformat: "none" };
    const layout = {
      paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", barmode: "group", bargap: 0.35, separators: ".\u2009", dragmode: "zoom",
      font: { family: getComputedStyle(document.body).fontFamily, size: 12, color: theme.ink },
      margin: { l: 64, r: 14, t: 30, b: 46 }, hovermode: this.spec.categories.length ? "closest" : "x unified",
      hoverlabel: { bgcolor: theme.page, bordercolor: theme.rule, font: { color: theme.ink } },
      legend: { orientation: "h", x: 0, y: 1.01, xanchor: "left", yanchor: "bottom", font: { size: 12 } },
      shapes: [], annotations: [],
    };
    layout.xaxis = { ...axisStyle, mirror: "all", zeroline: false, hoverformat: ".4~g", anchor: n > 1 ? "y" + n : "y", title: { text: this.spec.categories.length ? "" : this.label(this.abscissa), standoff: 8 }, type: this.spec.categories.length ? "category" : this.abscissa.log ? "log" : "linear" };
    if (!this.spec.categories.length) layout.xaxis.range = this.range || undefined;
    this.spec.panels.forEach((panel, i) => {
      const top = 1 - i * (share + gap);
      layout[i ? "yaxis" + (i + 1) : "yaxis"] = {
        ...axisStyle, title: { text: this.label(panel), standoff: 6, font: { size: n > 2 ? 11 : 12 } }, domain: [Math.max(top - share, 0), top],
        range: panel.limits || this.windowed(i) || undefined, rangemode: panel.from_zero ? "tozero" : "normal", nticks: n > 2 ? 4 : undefined,
      };
    });
    for (const mark of this.spec.marks) this.addMark(layout, mark, theme, n);
    return layout;
  }
  // Where the figure opens on a part of its abscissa the ordinates suit that part.
  windowed(panel) {
    if (!this.range || this.spec.slider || this.abscissa !== this.spec.abscissae[0]) return null;
    const [a, b] = this.range;
    let low = this.spec.panels[panel].from_zero ? 0 : Infinity, high = -Infinity;
    for (const s of this.spec.series) {
      if (s.panel !== panel || !(this.abscissa.key in s.x)) continue;
      const x = this.values(s.x[this.abscissa.key]), y = this.values(s.y);
      for (let i = 0; i < x.length; i++) if (x[i] >= a && x[i] <= b && Number.isFinite(y[i])) { low = Math.min(low, y[i]); high = Math.max(high, y[i]); }
    }
    const pad = 0.06 * (high - low);
    return high > low ? [this.spec.panels[panel].from_zero && low >= 0 ? 0 : low - pad, high + pad] : null;
  }
  addMark(layout, mark, theme, n) {
    const axis = mark.panel ? "y" + (mark.panel + 1) : "y";
    const line = { color: theme.muted, width: 1, dash: "dot" };
    const text = { text: MOYAI.escape(mark.label), showarrow: false, font: { size: 11, color: theme.muted }, bgcolor: theme.page, borderpad: 1 };
    const first = this.abscissa === this.spec.abscissae[0];
    // shapes take values of a logarithmic axis, annotations their logarithm
    const place = this.abscissa.log && mark.x !== null ? Math.log10(mark.x) : mark.x;
    if (mark.x !== null && mark.y !== null && first) {
      layout.annotations.push({ ...text, showarrow: true, arrowhead: 6, arrowsize: 0.7, arrowwidth: 1.2, arrowcolor: theme.bad, ax: 40, ay: -14, xanchor: "left", x: place, y: mark.y, yref: axis, font: { size: 11, color: theme.ink } });
    } else if (mark.x !== null && first) {
      layout.shapes.push({ type: "line", x0: mark.x, x1: mark.x, yref: "paper", y0: 0, y1: 1, line });
      layout.annotations.push({ ...text, x: place, yref: "paper", y: 0, yanchor: "bottom", textangle: -90, xanchor: "right" });
    } else if (mark.x === null && mark.y !== null) {
      layout.shapes.push({ type: "line", xref: "paper", x0: 0, x1: 1, yref: axis, y0: mark.y, y1: mark.y, line });
      layout.annotations.push({ ...text, xref: "paper", x: 0.995, xanchor: "right", yref: axis, y: mark.y, yanchor: "bottom" });
    }
  }
  drawIfVisible() {
    if (!this.drawn && window.Plotly && MOYAI.isVisible(this.plot)) this.draw();
  }
  redraw() {
    if (this.drawn && MOYAI.isVisible(this.plot)) this.draw();
    else if (this.drawn) { Plotly.purge(this.plot); this.drawn = false; }
  }
  draw() {
    const theme = MOYAI.theme(MOYAI.printing);
    if (this.range === undefined && this.abscissa === this.spec.abscissae[0]) this.range = this.spec.window || null;
    const layout = this.layout(theme), traces = this.traces(theme);
    layout.width = MOYAI.printing ? 672 : undefined;
    layout.height = MOYAI.printing ? Math.round(0.86 * this.spec.height) : this.tall || this.spec.height + this.legendHeight(traces);
    this.plot.style.height = `${layout.height}px`;
    layout.autosize = !MOYAI.printing;
    Plotly.react(this.plot, traces, layout, { displayModeBar: false, responsive: true, doubleClick: "reset+autosize" });
    if (!this.drawn) this.plot.on("plotly_relayout", (change) => this.relayouted(change));
    this.drawn = true;
    this.plot.classList.remove("waiting");
    if (this.overview) this.overview.paint();
  }
  // What a legend of more than two rows needs is added, so that a narrow figure keeps its plot.
  legendHeight(traces) {
    const words = traces.filter((trace) => trace.showlegend).map((trace) => trace.name.replace(/<[^>]*>|&\w+;/g, "").length);
    const columns = Math.max(1, Math.floor((this.plot.clientWidth - 78) / (46 + 6.6 * Math.max(0, ...words))));
    return 19 * Math.max(0, Math.ceil(words.length / columns) - 2);
  }
  relayouted(change) {
    if ("xaxis.range[0]" in change) this.range = [change["xaxis.range[0]"], change["xaxis.range[1]"]];
    else if (change["xaxis.range"]) this.range = change["xaxis.range"];
    else if (change["xaxis.autorange"]) this.range = null;
    else return;
    if (this.overview) this.overview.paint();
  }
  show(range) {
    this.range = range;
    Plotly.relayout(this.plot, range ? { "xaxis.range": range } : { "xaxis.autorange": true });
  }
  csv() {
    if (this.spec.csv) return this.spec.csv;
    const label = (name, unit) => (unit ? `${name} [${unit}]` : name);
    const groups = new Map(), columns = [];
    for (const s of this.spec.series) {
      const key = JSON.stringify(s.x);
      if (!groups.has(key)) groups.set(key, []);
      groups.get(key).push(s);
    }
    for (const members of groups.values()) {
      for (const a of this.spec.abscissae) if (a.key in members[0].x) columns.push([label(a.label, a.unit), this.values(members[0].x[a.key])]);
      for (const s of members) {
        const panel = this.spec.panels[s.panel];
        const name = this.spec.panels.length === 1 || s.label === panel.label ? s.label : `${panel.label}: ${s.label}`;
        columns.push([label(name, panel.unit), this.values(s.y)]);
      }
    }
    const quote = (t) => (/[",\n]/.test(t) ? `"${t.replace(/"/g, '""')}"` : /^[=+@\t\r]/.test(t) ? "'" + t : t);
    const number = (v) => (Number.isFinite(v) ? String(Number(v.toPrecision(7))) : "");
    const rows = [columns.map((c) => quote(c[0])).join(",")];
    const length = Math.max(...columns.map((c) => c[1].length));
    for (let i = 0; i < length; i++) rows.push(columns.map((c) => (i < c[1].length ? number(c[1][i]) : "")).join(","));
    return rows.join("\n") + "\n";
  }
  async picture(format) {
    const theme = MOYAI.theme(true), layout = this.layout(theme);
    layout.paper_bgcolor = theme.page;
    layout.title = { text: MOYAI.escape(this.spec.title), x: 0.01, xanchor: "left", font: { size: 15 } };
    layout.margin.t = 64;
    const size = { width: 900, height: this.spec.height + 60 };
    const address = await Plotly.toImage({ data: this.traces(theme), layout: { ...layout, ...size } }, { format, ...size, scale: format === "png" ? 2 : 1 });
    return (await fetch(address)).blob();
  }
  async clicked(button) {
    if (!button) return;
    const name = this.spec.key;
    if (button.dataset.abscissa) {
      this.abscissa = this.spec.abscissae.find((a) => a.key === button.dataset.abscissa);
      this.range = undefined;
      for (const b of this.element.querySelectorAll("[data-abscissa]")) b.setAttribute("aria-pressed", String(b === button));
      this.draw();
    } else if (button.dataset.do === "csv") MOYAI.saveCsv(name, this.csv());
    else if (button.dataset.do === "copy") MOYAI.acknowledge(button, (await MOYAI.copy(MOYAI.tabbed(this.csv()))) ? MOYAI.say("Copied") : MOYAI.say("Refused"));
    else if (button.dataset.do) MOYAI.save(`${name}.${button.dataset.do}`, await this.picture(button.dataset.do));
  }
}

// The strip below a long record: all of it in small, the part that is shown framed; drag the frame or its edges.
class Overview {
  constructor(canvas, figure) {
    Object.assign(this, { canvas, figure, grip: null });
    canvas.addEventListener("pointerdown", (e) => this.press(e));
    canvas.addEventListener("pointermove", (e) => this.move(e));
    canvas.addEventListener("pointerup", () => { this.grip = null; });
    canvas.addEventListener("dblclick", () => figure.show(null));
    canvas.addEventListener("keydown", (e) => this.key(e));
    new ResizeObserver(() => this.paint()).observe(canvas);
  }
  extent() {
    const s = this.figure.spec.series[this.figure.spec.series.length - 1];
    const x = this.figure.values(s.x[this.figure.abscissa.key]);
    return { x, y: this.figure.values(s.y), low: x[0], high: x[x.length - 1] };
  }
  shown() {
    const { low, high } = this.extent(), r = this.figure.range;
    return r ? [Math.max(r[0], low), Math.min(r[1], high)] : [low, high];
  }
  paint() {
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight, ratio = window.devicePixelRatio || 1;
    if (!width) return;
    this.canvas.width = width * ratio;
    this.canvas.height = height * ratio;
    const pen = this.canvas.getContext("2d"), theme = MOYAI.theme(MOYAI.printing), { x, y, low, high } = this.extent();
    pen.scale(ratio, ratio);
    const px = (v) => ((v - low) / (high - low || 1)) * (width - 2) + 1;
    let min = Infinity, max = -Infinity;
    for (const v of y) { if (v < min) min = v; if (v > max) max = v; }
    pen.strokeStyle = theme.muted;
    pen.lineWidth = 0.6;
    pen.beginPath();
    for (let i = 0; i < x.length; i++) if (Number.isFinite(y[i])) pen.lineTo(px(x[i]), height - 4 - ((y[i] - min) / (max - min || 1)) * (height - 8));
    pen.stroke();
    const [a, b] = this.shown().map(px), w = Math.max(b - a, 3);
    pen.fillStyle = theme.accent;
    pen.globalAlpha = 0.16;
    pen.fillRect(a, 0, w, height);
    pen.globalAlpha = 1;
    pen.fillRect(a, 0, 2, height);
    pen.fillRect(a + w - 2, 0, 2, height);
    pen.strokeStyle = theme.rule;
    pen.strokeRect(0.5, 0.5, width - 1, height - 1);
    this.canvas.setAttribute("aria-valuetext", this.shown().map((v) => MOYAI.number(v, 4)).join(" to "));
  }
  at(event) {
    const box = this.canvas.getBoundingClientRect(), { low, high } = this.extent();
    return low + ((event.clientX - box.left) / box.width) * (high - low);
  }
  press(event) {
    const here = this.at(event), { low, high } = this.extent(), [a, b] = this.shown();
    const near = (8 / this.canvas.clientWidth) * (high - low);
    const which = Math.abs(here - a) < near ? "start" : Math.abs(here - b) < near ? "end" : "both";
    this.grip = { which, from: here, a, b };
    if (which === "both" && (here < a || here > b)) this.slide(here - (a + b) / 2);
    try { this.canvas.setPointerCapture(event.pointerId); } catch (none) { /* a pointer that is gone by now */ }
  }
  move(event) {
    if (!this.grip) return;
    const { which, from, a, b } = this.grip, here = this.at(event), { low, high } = this.extent(), least = (high - low) / 2000;
    if (which === "start") this.figure.show([Math.max(low, Math.min(here, b - least)), b]);
    else if (which === "end") this.figure.show([a, Math.min(high, Math.max(here, a + least))]);
    else this.slide(here - from, a, b);
  }
  slide(by, a = this.shown()[0], b = this.shown()[1]) {
    const { low, high } = this.extent(), shift = Math.max(low - a, Math.min(by, high - b));
    this.figure.show([a + shift, b + shift]);
    if (this.grip && arguments.length === 1) Object.assign(this.grip, { a: a + shift, b: b + shift });
  }
  key(event) {
    const [a, b] = this.shown(), span = b - a, { low, high } = this.extent();
    if (event.key === "ArrowRight") this.slide(span / 4);
    else if (event.key === "ArrowLeft") this.slide(-span / 4);
    else if (event.key === "ArrowUp") this.figure.show([a + span / 6, b - span / 6]);
    else if (event.key === "ArrowDown") this.figure.show([Math.max(low, a - span / 4), Math.min(high, b + span / 4)]);
    else return;
    event.preventDefault();
  }
}

MOYAI.Figure = Figure;
MOYAI.ready = (async () => {
  await MOYAI.unpacked;
  for (const element of document.querySelectorAll("[data-figure]")) MOYAI.figures.set(element.dataset.figure, new Figure(element));
  const packed = document.getElementById("packed-plotly");
  if (!packed) return;
  for (const figure of MOYAI.figures.values()) figure.plot.classList.add("waiting");
  await new Promise((then) => setTimeout(then));
  const script = document.createElement("script");
  script.textContent = await (await MOYAI.inflate(packed)).text();
  document.head.append(script);
  MOYAI.drawVisible();
})().catch((fault) => MOYAI.undrawn(document.querySelectorAll("[data-figure] .plot"), fault));
