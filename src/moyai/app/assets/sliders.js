// Sliders of the numbers that matter, each with a field for the exact number; units as the file writes them.
import { element, say } from "/assets/server.js";

export class Sliders {
  constructor(moved) {
    this.moved = moved;
    this.rows = new Map();
    this.element = element("div", { class: "sliders", role: "group", "aria-label": say("Numbers of the case") });
  }
  show(sliders) {
    const paths = sliders.map((one) => one.path).join("\n");
    if (paths !== this.paths) {
      this.paths = paths;
      this.rows = new Map(sliders.map((one) => [one.path, this.row(one)]));
      this.element.replaceChildren(...[...this.rows.values()].map((row) => row.element));
    }
    for (const one of sliders) this.update(this.rows.get(one.path), one);
  }
  row(spec) {
    const id = `slider-${spec.path.replace(/\W+/g, "-")}`;
    const range = element("input", { type: "range", id });
    const number = element("input", { type: "number", step: "any", "aria-label": say("{0}, number", spec.label) });
    const unit = element("span", { class: "unit" }, spec.unit);
    const row = { spec, range, number, unit, held: false };
    row.element = element("div", { class: "slider" }, element("label", { for: id, title: spec.path }, spec.label), range, number, unit);
    range.addEventListener("pointerdown", () => { row.held = true; });
    range.addEventListener("input", () => {
      const text = this.digits(row.spec, Number(range.value));
      number.value = text;
      this.moved(spec.path, text);
    });
    range.addEventListener("change", () => { row.held = false; });
    number.addEventListener("change", () => {
      if (number.value !== "" && Number.isFinite(Number(number.value))) this.moved(spec.path, number.value);
    });
    return row;
  }
  digits(spec, value) { return value.toFixed(spec.decimals).replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, "") || "0"; }
  update(row, spec) {
    // The range stays while the value is inside, so that the handle does not run away under the pointer
    const inside = row.shown && spec.value > row.shown.low && spec.value < row.shown.high && row.shown.unit === spec.unit;
    if (!inside && !row.held) {
      row.shown = spec;
      row.spec = spec;
      Object.assign(row.range, { min: spec.low, max: spec.high, step: spec.step });
    }
    row.unit.textContent = spec.unit;
    if (row.held || document.activeElement === row.number) return;
    if (Number(row.range.value) !== spec.value) row.range.value = spec.value;
    row.number.value = String(spec.value);
  }
}
