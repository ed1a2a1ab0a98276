// The text of the case: line numbers, marks of errors by line, jumps to them. A plain text area with a gutter.
import { element, faultWords } from "/assets/server.js";

export class Editor {
  constructor(changed) {
    this.area = element("textarea", { spellcheck: "false", autocapitalize: "off", autocomplete: "off", wrap: "off", "aria-label": "Case file (YAML)", "aria-describedby": "faults" });
    this.gutter = element("div", { class: "gutter", "aria-hidden": "true" });
    this.list = element("ul", { class: "notices faults", id: "faults", "aria-live": "polite" });
    this.element = element("div", { class: "text" }, element("div", { class: "editor" }, this.gutter, this.area), this.list);
    this.marks = new Map();
    this.area.addEventListener("input", () => { this.number(); changed(this.area.value); });
    this.area.addEventListener("scroll", () => { this.gutter.scrollTop = this.area.scrollTop; });
    // Tab leaves the text, as everywhere on the page; two spaces indent
  }
  get text() { return this.area.value; }
  set text(text) {
    if (this.area.value === text) return;
    const { selectionStart, selectionEnd, scrollTop, scrollLeft } = this.area;
    this.area.value = text;
    this.area.setSelectionRange(Math.min(selectionStart, text.length), Math.min(selectionEnd, text.length));
    this.area.scrollTop = scrollTop;
    this.area.scrollLeft = scrollLeft;
    this.number();
  }
  number() {
    const count = this.area.value.split("\n").length;
    if (count === this.count && !this.dirty) return;
    this.count = count;
    this.dirty = false;
    this.gutter.replaceChildren(...Array.from({ length: count }, (_, i) => {
      const tone = this.marks.get(i + 1);
      return element("span", tone ? { class: tone } : {}, String(i + 1));
    }));
    this.gutter.scrollTop = this.area.scrollTop;
  }
  show(faults, warnings) {
    const marks = new Map();
    for (const one of warnings) marks.set(one.line, "warning");
    for (const one of faults) marks.set(one.line, "error");
    const same = marks.size === this.marks.size && [...marks].every(([line, tone]) => this.marks.get(line) === tone);
    this.marks = marks;
    if (!same) { this.dirty = true; this.number(); }
    const item = (one, tone, word) => element("li", { class: `notice ${tone}` }, element("strong", {}, word),
      element("span", {}, one.line ? element("button", { type: "button", onclick: () => this.jump(one.line, one.column) }, `line ${one.line}`) : null, " ", faultWords(one)));
    this.list.replaceChildren(...faults.map((one) => item(one, "error", "Error")), ...warnings.map((one) => item(one, "warning", "Warning")));
    this.area.setAttribute("aria-invalid", String(faults.length > 0));
  }
  jump(line, column) {
    const lines = this.area.value.split("\n"), before = lines.slice(0, line - 1).reduce((sum, one) => sum + one.length + 1, 0);
    this.area.focus();
    this.area.setSelectionRange(before + Math.max(0, column - 1), before + lines[line - 1].length);
    const height = this.area.scrollHeight / lines.length;
    this.area.scrollTop = Math.max(0, (line - 5) * height);
  }
}
