// Canvas player: a transport (play, scrub, speed, marks, keyboard) that drives a painter. The painter of a side view is
// here; a painter of another kind (3-D) registers itself as MOYAI.painters[kind] with extents(), paint() and readouts().
"use strict";

// Motion stored as mean + basis x coefficients(frame): cubic between frames, so that coarse frames still run smoothly.
class Track {
  constructor(coded, times) {
    this.times = times;
    this.mean = MOYAI.array(coded.mean);
    this.basis = coded.basis.map(MOYAI.array);
    this.coefficients = MOYAI.quantised(coded.coefficients);
    this.out = new Float64Array(this.mean.length);
  }
  at(place) {
    const { columns, values } = this.coefficients, { i, u, h, before, after } = place, out = this.out;
    out.set(this.mean);
    for (let c = 0; c < columns; c++) {
      const get = (frame) => values[frame * columns + c];
      const a = get(i), b = get(i + 1);
      const sa = before ? (b - get(i - 1)) / before : (b - a) / h, sb = after ? (get(i + 2) - a) / after : (b - a) / h;
      const value = a + u * (h * sa + u * (3 * (b - a) - h * (2 * sa + sb) + u * (2 * (a - b) + h * (sa + sb))));
      const shape = this.basis[c];
      for (let k = 0; k < out.length; k++) out[k] += value * shape[k];
    }
    return out;
  }
}
MOYAI.Track = Track;
MOYAI.placeInTime = (times, t) => {
  let low = 0, high = times.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle; else high = middle;
  }
  const h = times[low + 1] - times[low];
  return {
    i: low, h, u: Math.max(0, Math.min(1, (t - times[low]) / h)),
    before: low > 0 ? times[low + 1] - times[low - 1] : 0, after: low + 2 < times.length ? times[low + 2] - times[low] : 0,
  };
};

// Colour and width both grow with the load, so that the reading is not attached to colour.
MOYAI.loadColour = (fraction) => {
  const stops = [[134, 170, 200], [84, 120, 180], [110, 76, 160], [176, 48, 116], [214, 48, 31]];
  const f = Math.max(0, Math.min(0.9999, fraction)) * (stops.length - 1), i = Math.floor(f), r = f - i;
  return `rgb(${stops[i].map((v, k) => Math.round(v + r * (stops[i + 1][k] - v))).join(",")})`;
};

class SideView {
  constructor(scene) {
    this.scene = scene;
    this.times = MOYAI.array(scene.times);
    const track = (coded) => new Track(coded, this.times);
    this.bodies = scene.bodies.map((b) => ({ ...b, outlines: b.outlines.map((o) => [MOYAI.array(o[0]), MOYAI.array(o[1])]), track: track(b.pose) }));
    this.lines = scene.lines.map((l) => ({ ...l, track: track(l.path), tension: MOYAI.array(l.tension) }));
    this.surface = scene.surface ? { x: MOYAI.array(scene.surface.x), track: track(scene.surface.elevation) } : null;
    this.views = Object.keys(scene.extents);
    this.scale = Math.max(1e-12, ...this.lines.map((l) => l.maximum).filter(Number.isFinite));
  }
  aspect(view) {
    const [x0, x1, z0, z1] = this.scene.extents[view];
    return (z1 - z0) / (x1 - x0);
  }
  paint(pen, width, height, t, view) {
    const theme = MOYAI.theme(MOYAI.printing), s = MOYAI.style, [x0, x1, z0, z1] = this.scene.extents[view];
    const top = 26, bottom = 22, scale = Math.min(width / (x1 - x0), (height - top - bottom) / (z1 - z0));
    const left = (width - scale * (x1 - x0)) / 2, middle = height - bottom - scale * (z1 - z0);
    const X = (x) => left + (x - x0) * scale, Z = (z) => middle + (z1 - z) * scale;
    const place = MOYAI.placeInTime(this.times, t);
    pen.fillStyle = theme.page;
    pen.fillRect(0, 0, width, height);
    const floor = this.scene.bed === null ? height : Z(this.scene.bed);
    this.paintWater(pen, X, Z, place, floor, width, s);
    if (this.scene.bed !== null) {
      pen.fillStyle = s("--bed");
      pen.fillRect(0, floor, width, height - floor);
      pen.strokeStyle = theme.ink;
      pen.lineWidth = 1;
      pen.beginPath(); pen.moveTo(0, floor); pen.lineTo(width, floor); pen.stroke();
    }
    for (const line of this.lines) this.paintLine(pen, X, Z, place, line, theme);
    for (const body of this.bodies) this.paintBody(pen, X, Z, place, body, theme, s);
    this.paintScale(pen, scale, width, height, theme);
    pen.font = `12px ${getComputedStyle(document.body).fontFamily}`;
    pen.fillStyle = theme.ink;
    pen.textAlign = "left";
    pen.fillText(`t = ${t.toFixed(2)} s`, 10, 17);
    const load = this.governing(place);
    if (load) {
      pen.textAlign = "right";
      pen.fillStyle = load.atMaximum ? s("--bad") : theme.ink;
      pen.fillText(`${load.atMaximum ? `${MOYAI.say("maximum")}: ` : ""}${load.name} ${load.text}`, width - 10, 17);
    }
  }
  paintWater(pen, X, Z, place, floor, width, s) {
    pen.beginPath();
    if (this.surface) {
      const z = this.surface.track.at(place), x = this.surface.x;
      pen.moveTo(Math.min(0, X(x[0])), Z(z[0]));
      for (let k = 0; k < x.length; k++) pen.lineTo(X(x[k]), Z(z[k]));
      pen.lineTo(Math.max(width, X(x[x.length - 1])), Z(z[x.length - 1]));
    } else { pen.moveTo(0, Z(0)); pen.lineTo(width, Z(0)); }
    pen.strokeStyle = s("--water-line");
    pen.lineWidth = 1.6;
    pen.stroke();
    pen.lineTo(width, floor); pen.lineTo(0, floor); pen.closePath();
    pen.fillStyle = s("--water");
    pen.fill();
    pen.setLineDash([3, 5]);
    pen.lineWidth = 0.7;
    pen.beginPath(); pen.moveTo(0, Z(0)); pen.lineTo(width, Z(0)); pen.stroke();
    pen.setLineDash([]);
  }
  paintLine(pen, X, Z, place, line, theme) {
    const p = line.track.at(place), n = p.length / 2, tension = this.tensionAt(line, place);
    const fraction = Number.isFinite(tension) ? tension / this.scale : 0;
    pen.lineJoin = "round";
    pen.lineCap = "round";
    pen.beginPath();
    for (let k = 0; k < n; k++) pen.lineTo(X(p[k]), Z(p[n + k]));
    pen.strokeStyle = MOYAI.loadColour(fraction);
    pen.lineWidth = 1.6 + 2.6 * Math.max(0, Math.min(1, fraction));
    pen.stroke();
    pen.fillStyle = theme.ink;
    pen.fillRect(X(p[0]) - 3, Z(p[n]) - 3, 6, 6);
  }
  paintBody(pen, X, Z, place, body, theme, s) {
    const [dx, dz, angle] = body.track.at(place), [px, pz] = body.pivot, c = Math.cos(angle), sn = Math.sin(angle);
    // positive roll turns the top towards +x: (rx, rz) -> (rx cos + rz sin, rz cos - rx sin)
    const move = (x, z) => [X(px + dx + (x - px) * c + (z - pz) * sn), Z(pz + dz + (z - pz) * c - (x - px) * sn)];
    pen.fillStyle = s("--hull");
    pen.strokeStyle = theme.ink;
    pen.lineWidth = 1.6;
    for (const [xs, zs] of body.outlines) {
      pen.beginPath();
      for (let k = 0; k < xs.length; k++) pen.lineTo(...move(xs[k], zs[k]));
      pen.closePath(); pen.fill(); pen.stroke();
    }
    const [gx, gz] = move(px, pz), [rx, rz] = [X(px), Z(pz)];
    pen.strokeStyle = theme.muted;
    pen.lineWidth = 1;
    pen.beginPath(); pen.moveTo(rx - 5, rz); pen.lineTo(rx + 5, rz); pen.moveTo(rx, rz - 5); pen.lineTo(rx, rz + 5); pen.stroke();
    pen.fillStyle = theme.ink;
    pen.beginPath(); pen.arc(gx, gz, 3, 0, 2 * Math.PI); pen.fill();
  }
  paintScale(pen, scale, width, height, theme) {
    const target = 110 / scale, ten = 10 ** Math.floor(Math.log10(target));
    const length = [5, 2, 1].map((m) => m * ten).find((m) => m <= target) || ten, x = 12, y = height - 8;
    pen.strokeStyle = pen.fillStyle = theme.ink;
    pen.lineWidth = 1.4;
    pen.beginPath(); pen.moveTo(x, y - 4); pen.lineTo(x, y); pen.lineTo(x + length * scale, y); pen.lineTo(x + length * scale, y - 4); pen.stroke();
    pen.font = "11px sans-serif";
    pen.textAlign = "left";
    pen.fillText(`${length} m`, x + length * scale + 6, y);
  }
  tensionAt(line, place) {
    return line.tension[place.i] * (1 - place.u) + line.tension[place.i + 1] * place.u;
  }
  governing(place) {
    let best = null;
    for (const line of this.lines) {
      const now = this.tensionAt(line, place);
      if (Number.isFinite(now) && (!best || now > best.now)) best = { now, line };
    }
    if (!best) return null;
    const { line, now } = best;
    return { name: line.name, text: `${MOYAI.number(now * line.factor)} ${line.unit}`, atMaximum: now >= 0.995 * this.scale };
  }
  readouts(t) {
    const place = MOYAI.placeInTime(this.times, t), theme = MOYAI.theme(false), rows = [];
    for (const body of this.bodies) {
      const p = body.track.at(place);
      rows.push({ label: MOYAI.say("sway, heave, roll"), value: `${MOYAI.number(p[0])} m, ${MOYAI.number(p[1])} m, ${MOYAI.number((p[2] * 180) / Math.PI)}°`, extreme: "", colour: theme.ink });
    }
    for (const line of this.lines) {
      const now = this.tensionAt(line, place);
      const used = (load) => Number.isFinite(line.breaking) && line.breaking ? ` (${MOYAI.number((100 * load) / line.breaking, 2)} %)` : "";
      const said = (load) => `${MOYAI.number(load * line.factor)} ${line.unit}${used(load)}`;
      rows.push({ label: line.name, value: said(now), extreme: `${MOYAI.say("max")} ${said(line.maximum)}`, colour: MOYAI.loadColour(now / this.scale) });
    }
    return rows;
  }
}
MOYAI.painters["side-view"] = SideView;

class Player {
  constructor(holder) {
    const scene = MOYAI.data.scenes[holder.dataset.scene];
    Object.assign(this, { holder, scene, painter: null, t: scene.start, playing: false, speed: scene.speed, whole: false, last: 0 });
    this.view = Object.keys(scene.extents)[0];
    holder.tabIndex = 0;
    holder.setAttribute("role", "group");
    holder.setAttribute("aria-label", MOYAI.say("Animation. Space plays, arrows step, M jumps to the maximum, V changes the view, W the span, plus and minus the speed."));
    this.build();
    this.visibilityChanged();
    new ResizeObserver(() => this.repaint()).observe(holder);
  }
  element(kind, properties, ...children) {
    const made = Object.assign(document.createElement(kind), properties);
    made.append(...children);
    return made;
  }
  build() {
    const button = (text, title, act) => this.element("button", { type: "button", textContent: text, title, onclick: act });
    this.canvas = this.element("canvas", {});
    this.playButton = button(`▶ ${MOYAI.say("Play")}`, MOYAI.say("Space"), () => this.toggle());
    this.playButton.className = "play";
    this.scrub = this.element("input", { type: "range", min: 0, max: 1000, step: "any", oninput: () => this.seek(this.fromScrub()) });
    this.scrub.setAttribute("aria-label", MOYAI.say("Time"));
    this.clock = this.element("span", { className: "clock" });
    this.speeds = [0.02, 0.05, 0.1, 0.25, 0.5, 1, 2, 5, 10, 20];
    this.speedSelect = this.element("select", { title: MOYAI.say("Speed (plus, minus)"), onchange: () => { this.speed = Number(this.speedSelect.value); } },
      ...this.speeds.map((v) => this.element("option", { value: v, textContent: `${v}×` })));
    this.speedSelect.value = this.speed;
    this.spanButton = button("", "W", () => { this.whole = !this.whole; this.repaint(); });
    this.viewButton = button("", "V", () => this.nextView());
    const bar = this.element("div", { className: "transport" }, this.playButton, this.scrub, this.clock, this.speedSelect,
      button(MOYAI.say("Maximum"), "M", () => this.toMaximum()), this.spanButton, this.viewButton,
      button("PNG", MOYAI.say("Save this picture"), () => this.still()));
    this.readouts = this.element("div", { className: "readouts" });
    this.holder.append(this.canvas, bar, this.readouts);
    this.holder.addEventListener("keydown", (event) => this.key(event));
  }
  // Unpacking waits until the scene is seen.
  visibilityChanged() {
    if (!MOYAI.isVisible(this.holder)) { this.pause(); return; }
    if (!this.painter) {
      this.painter = new MOYAI.painters[this.scene.kind](this.scene);
      if (this.painter.attach) this.painter.attach(this); // it listens to the pointer itself
    }
    this.repaint();
  }
  span() {
    const times = this.painter.times;
    return this.whole ? [times[0], times[times.length - 1]] : this.scene.window;
  }
  fromScrub() {
    const [a, b] = this.span();
    return a + (Number(this.scrub.value) / 1000) * (b - a);
  }
  seek(t) {
    const [a, b] = this.span();
    this.t = Math.max(a, Math.min(b, t));
    this.repaint();
  }
  toMaximum() { this.pause(); this.seek(this.scene.maximum); }
  nextView() {
    const views = Object.keys(this.scene.extents);
    this.view = views[(views.indexOf(this.view) + 1) % views.length];
    this.repaint();
  }
  toggle() { if (this.playing) this.pause(); else this.play(); }
  pause() {
    this.playing = false;
    this.playButton.textContent = `▶ ${MOYAI.say("Play")}`;
  }
  play() {
    this.playing = true;
    this.last = performance.now();
    this.playButton.textContent = `❚❚ ${MOYAI.say("Pause")}`;
    const [a, b] = this.span();
    if (this.t >= b || this.t < a) this.t = a;
    const turn = (now) => {
      if (!this.playing) return;
      const [start, end] = this.span();
      this.t += (Math.min(now - this.last, 100) / 1000) * this.speed;
      this.last = now;
      if (this.t > end) this.t = start;
      this.repaint();
      requestAnimationFrame(turn);
    };
    requestAnimationFrame(turn);
  }
  step(direction, large) {
    this.pause();
    const times = this.painter.times, place = MOYAI.placeInTime(times, this.t);
    this.seek(this.t + direction * (large ? 10 : 1) * Math.max(place.h, 1e-6));
  }
  key(event) {
    if (!this.painter || event.target.matches("input, select") || event.ctrlKey || event.metaKey || event.altKey) return;
    const [a, b] = this.span();
    const faster = (by) => {
      const i = Math.max(0, Math.min(this.speeds.length - 1, this.speeds.indexOf(this.speed) + by));
      this.speed = this.speeds[i];
      this.speedSelect.value = this.speed;
    };
    const acts = {
      " ": () => this.toggle(), ArrowRight: () => this.step(1, event.shiftKey), ArrowLeft: () => this.step(-1, event.shiftKey),
      Home: () => this.seek(a), End: () => this.seek(b), m: () => this.toMaximum(), v: () => this.nextView(),
      w: () => { this.whole = !this.whole; this.repaint(); }, "+": () => faster(1), "-": () => faster(-1),
    };
    const act = acts[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act || (event.key === " " && event.target.matches("button"))) return;
    event.preventDefault();
    act();
  }
  repaint() {
    if (!this.painter || !MOYAI.isVisible(this.holder)) return;
    const width = MOYAI.printing ? 670 : this.canvas.clientWidth || this.holder.clientWidth;
    const height = Math.round(Math.max(180, Math.min(this.tall || this.painter.tallest || 430, width * this.painter.aspect(this.view) + 48)));
    const ratio = MOYAI.printing ? 3 : window.devicePixelRatio || 1;
    if (this.canvas.width !== Math.round(width * ratio) || this.canvas.height !== Math.round(height * ratio)) {
      this.canvas.width = Math.round(width * ratio);
      this.canvas.height = Math.round(height * ratio);
      this.canvas.style.height = `${height}px`;
    }
    const pen = this.canvas.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.painter.paint(pen, width, height, this.t, this.view);
    const [a, b] = this.span();
    this.scrub.value = (1000 * (this.t - a)) / (b - a || 1);
    this.clock.textContent = `${this.t.toFixed(2)} s`;
    this.scrub.setAttribute("aria-valuetext", this.clock.textContent);
    this.spanButton.textContent = MOYAI.say(this.whole ? "Show window" : "Whole record");
    this.spanButton.hidden = this.scene.window[0] <= this.painter.times[0] && this.scene.window[1] >= this.painter.times[this.painter.times.length - 1];
    const views = Object.keys(this.scene.extents);
    this.viewButton.textContent = MOYAI.say(views[(views.indexOf(this.view) + 1) % views.length]);
    this.viewButton.hidden = views.length < 2;
    this.tell(this.painter.readouts(this.t));
  }
  tell(rows) {
    while (this.readouts.children.length < rows.length) {
      this.readouts.append(this.element("div", { className: "readout" }, this.element("i", {}), this.element("span", {}), this.element("b", {})));
      this.readouts.lastChild.children[1].append(this.element("span", {}), this.element("span", { className: "extreme" }));
    }
    rows.forEach((row, i) => {
      const [mark, words, value] = this.readouts.children[i].children;
      mark.style.background = row.colour;
      words.children[0].textContent = row.label;
      words.children[1].textContent = row.extreme ? `  ${row.extreme}` : "";
      value.textContent = row.value;
    });
  }
  still() {
    this.canvas.toBlob((blob) => MOYAI.save(`${this.holder.dataset.scene}-${this.t.toFixed(2)}s.png`, blob));
  }
}
MOYAI.Player = Player;
MOYAI.unpacked.then(() => {
  for (const holder of document.querySelectorAll(".player")) MOYAI.players.push(new Player(holder));
}).catch((fault) => MOYAI.undrawn(document.querySelectorAll(".player"), fault));
