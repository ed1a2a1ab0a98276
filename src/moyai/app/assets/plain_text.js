// The text of a case in a plain text area with line numbers: what is left where the editor cannot be loaded.
import { element, say } from "/assets/server.js";

export class PlainText {
  constructor({ changed }) {
    this.area = element("textarea", { spellcheck: "false", autocapitalize: "off", autocomplete: "off", wrap: "off", "aria-label": say("Case file (YAML)"), "aria-describedby": "faults" });
    this.gutter = element("div", { class: "gutter", "aria-hidden": "true" });
    this.element = element("div", { class: "editor plain" }, this.gutter, this.area);
    this.marks = new Map();
    this.area.addEventListener("input", () => { this.number(); changed(); });
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
  type(text) {
    this.area.value = text;
    this.area.dispatchEvent(new Event("input", { bubbles: true }));
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
  mark(faults, warnings) {
    this.marks = new Map();
    for (const one of warnings) this.marks.set(one.line, "warning");
    for (const one of faults) this.marks.set(one.line, "error");
    this.dirty = true;
    this.number();
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
