// Page behaviour: choices, downloads, copying, light and dark, printing. Figures and players register themselves.
"use strict";
const MOYAI = { figures: new Map(), players: [], painters: {} };
MOYAI.data = JSON.parse(document.getElementById("report-data").textContent);

// Arrays come as lists (null: not known), as packed single precision, or as integers of 8 or 16 bits with a scale per
// column. What is packed is base64, or [start, bytes, columns] of the block of numbers of the page (packing.py).
MOYAI.inflate = async (element) => new Response(new Blob([MOYAI.bytes(element.textContent)]).stream().pipeThrough(new DecompressionStream("gzip")));
MOYAI.bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
MOYAI.unpack = (coded, Kind) => {
  if (typeof coded === "string") return new Kind(MOYAI.bytes(coded).buffer);
  const [start, length, columns] = coded, width = Kind.BYTES_PER_ELEMENT, count = length / width, rows = count / columns;
  const words = new { 1: Uint8Array, 2: Uint16Array, 4: Uint32Array }[width](count);
  for (let column = 0, k = 0; column < columns; column++) {
    for (let row = 0, sum = 0; row < rows; row++, k++) {
      for (let byte = 0; byte < width; byte++) sum += MOYAI.numbers[start + byte * count + k] << (8 * byte);
      sum |= 0;
      words[row * columns + column] = sum;
    }
  }
  return new Kind(words.buffer);
};
MOYAI.numbers = new Uint8Array(0);
MOYAI.unpacked = (async () => {
  const packed = document.getElementById("packed-numbers");
  if (packed) MOYAI.numbers = new Uint8Array(await (await MOYAI.inflate(packed)).arrayBuffer());
})();
MOYAI.undrawn = (places, fault) => {
  for (const place of places) place.textContent = `${MOYAI.say("This could not be drawn; its data are in report.xlsx and results.nc. A browser of 2023 or newer is needed.")} (${fault.message})`;
};
MOYAI.array = (coded) => {
  if (Array.isArray(coded)) return coded.map((v) => (v === null ? NaN : v));
  return MOYAI.unpack(coded.f4, Float32Array);
};
MOYAI.quantised = (coded) => {
  const integers = coded.i1 ? MOYAI.unpack(coded.i1, Int8Array) : MOYAI.unpack(coded.i2, Int16Array);
  const out = new Float64Array(integers.length);
  for (let i = 0; i < integers.length; i++) {
    const c = i % coded.columns;
    out[i] = coded.offset[c] + coded.step[c] * integers[i];
  }
  return { columns: coded.columns, rows: integers.length / coded.columns, values: out };
};
MOYAI.number = (v, digits = 3) => {
  if (!Number.isFinite(v)) return "–";
  if (v === 0) return "0";
  const size = Math.floor(Math.log10(Math.abs(v)));
  const text = size >= digits ? v.toFixed(0) : size < -3 ? v.toExponential(digits - 1) : v.toFixed(digits - 1 - size);
  return text.replace("-", "−");
};
// A word of the page in its language; see SCRIPT_WORDS of html.py.
MOYAI.say = (text) => ((MOYAI.data && MOYAI.data.words) || {})[text] || text;
MOYAI.style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
MOYAI.pretty = (unit) => unit.replace(/\bdeg/g, "°").replace(/([A-Za-z°])(\d)/g, (m, a, d) => a + "⁰¹²³⁴⁵⁶⁷⁸⁹"[d]).replace(/ per /g, "\n").replace(/ /g, "·").replace(/\n/g, " per ");

MOYAI.save = (name, content, type) => {
  const blob = content instanceof Blob ? content : new Blob([content], { type });
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
};
// The byte order mark lets spreadsheets read UTF-8; copied text uses tabs, which paste into cells everywhere.
MOYAI.saveCsv = (name, csv) => MOYAI.save(name + ".csv", "\ufeff" + csv, "text/csv;charset=utf-8");
MOYAI.tabbed = (csv) => csv.replace(/("(?:[^"]|"")*")|,/g, (whole, quoted) => quoted || "\t");
MOYAI.copy = async (text) => {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch (refused) {
    const area = document.createElement("textarea");
    area.value = text;
    area.style.position = "fixed";
    document.body.append(area);
    area.select();
    const done = document.execCommand("copy");
    area.remove();
    return done;
  }
};
MOYAI.acknowledge = (button, text) => {
  const before = button.dataset.words || button.textContent;
  button.dataset.words = before;
  button.textContent = text;
  setTimeout(() => { button.textContent = before; }, 1200);
};

// Choices of one group change together. Only what becomes visible is drawn.
MOYAI.choose = (group, label) => {
  for (const choice of document.querySelectorAll(".choice")) {
    if (choice.dataset.group !== group) continue;
    const panes = [...choice.children].filter((c) => c.classList.contains("pane"));
    if (!panes.some((p) => p.dataset.option === label)) continue;
    for (const pane of panes) pane.hidden = pane.dataset.option !== label;
    const chooser = choice.querySelector(":scope > .chooser");
    if (!chooser) continue;
    for (const b of chooser.querySelectorAll("button")) b.setAttribute("aria-pressed", String(b.dataset.option === label));
    for (const s of chooser.querySelectorAll("select")) s.value = label;
  }
  MOYAI.drawVisible();
};
MOYAI.isVisible = (element) => element.getClientRects().length > 0;
MOYAI.drawVisible = () => {
  for (const figure of MOYAI.figures.values()) figure.drawIfVisible();
  for (const player of MOYAI.players) player.visibilityChanged();
};
MOYAI.redrawAll = () => {
  for (const figure of MOYAI.figures.values()) figure.redraw();
  for (const player of MOYAI.players) player.repaint();
};

document.addEventListener("change", (event) => {
  const select = event.target.closest("select[data-choose]");
  if (select) MOYAI.choose(select.dataset.choose, select.value);
});
document.addEventListener("click", async (event) => {
  const button = event.target.closest("button");
  if (!button) return;
  if (button.dataset.choose) {
    const before = button.getBoundingClientRect().top; // panes above may change height: keep the button under the pointer
    MOYAI.choose(button.dataset.choose, button.dataset.option);
    window.scrollBy({ top: button.getBoundingClientRect().top - before, behavior: "instant" });
    return;
  }
  const act = button.dataset.do;
  const table = button.closest("[data-table]"), drawing = button.closest("[data-drawing]");
  if (table && act === "csv") MOYAI.saveCsv(table.dataset.table, MOYAI.data.tables[table.dataset.table]);
  if (table && act === "copy") {
    MOYAI.acknowledge(button, (await MOYAI.copy(MOYAI.tabbed(MOYAI.data.tables[table.dataset.table]))) ? MOYAI.say("Copied") : MOYAI.say("Refused"));
  }
  if (drawing && act === "svg") MOYAI.save(drawing.dataset.drawing + ".svg", MOYAI.standaloneSvg(drawing.querySelector("svg")), "image/svg+xml");
});
// A drawing that leaves the page takes its colours along.
MOYAI.standaloneSvg = (svg) => {
  const copy = svg.cloneNode(true);
  const from = [svg, ...svg.querySelectorAll("*")], to = [copy, ...copy.querySelectorAll("*")];
  from.forEach((node, i) => {
    const style = getComputedStyle(node);
    for (const name of ["fill", "stroke", "stroke-width", "stroke-dasharray", "font-family", "font-size", "font-style"]) {
      to[i].style.setProperty(name, style.getPropertyValue(name));
    }
  });
  copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  return new XMLSerializer().serializeToString(copy);
};

// Paper is always light and of fixed width; folded parts open.
MOYAI.printing = false;
MOYAI.forPaper = (on) => {
  MOYAI.printing = on;
  document.documentElement.classList.toggle("paper", on);
  for (const d of document.querySelectorAll("details")) {
    if (on && !d.open) { d.open = true; d.dataset.opened = "1"; }
    else if (!on && d.dataset.opened) { d.open = false; delete d.dataset.opened; }
  }
  MOYAI.drawVisible();
  MOYAI.redrawAll();
};
window.addEventListener("beforeprint", () => MOYAI.forPaper(true));
window.addEventListener("afterprint", () => MOYAI.forPaper(false));
window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => MOYAI.redrawAll());
document.addEventListener("toggle", () => MOYAI.drawVisible(), true);
