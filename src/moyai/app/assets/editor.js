// The text of the case with its errors: CodeMirror, or a plain text area where its script cannot be loaded.
import { PlainText } from "/assets/plain_text.js";
import { element, faultWords, say } from "/assets/server.js";

export async function editorOf(wishes) {
  try {
    return new Editor(new (await import("/assets/code_text.js")).CodeText(wishes));
  } catch {
    return new Editor(new PlainText(wishes));
  }
}

class Editor {
  constructor(surface) {
    this.surface = surface;
    this.list = element("ul", { class: "notices faults", id: "faults", "aria-live": "polite" });
    this.element = element("div", { class: "text-pane" }, surface.element, this.list);
    this.element.editor = this;
  }
  get text() { return this.surface.text; }
  set text(text) { this.surface.text = text; }
  type(text) { this.surface.type(text); }
  show(faults, warnings) {
    const state = JSON.stringify([faults, warnings]);
    // Marks move with the text while it is typed; the same ones are put again only where they have changed
    if (state !== this.state || state !== "[[],[]]") this.surface.mark(faults, warnings);
    if (state === this.state) return;
    this.state = state;
    const item = (one, tone, word) => element("li", { class: `notice ${tone}` }, element("strong", {}, word),
      element("span", {}, one.line ? element("button", { type: "button", onclick: () => this.surface.jump(one.line, one.column) }, say("line {0}", one.line)) : null, " ", faultWords(one)));
    this.list.replaceChildren(...faults.map((one) => item(one, "error", say("Error"))), ...warnings.map((one) => item(one, "warning", say("Warning"))));
  }
}
