// Pinned states of a case: a name, a line as their curves have it, and a button that takes one away.
import { element, say } from "/assets/server.js";

const DASHES = ["7 4", "2 3", "7 3 2 3"];

export class Pins {
  // `change` is called with what the server takes: a pin and its name, nothing for a pin that goes.
  constructor(change) {
    this.change = change;
    this.element = element("ul", { class: "pins", "aria-label": say("Pinned states") });
  }
  show(pins) {
    const state = JSON.stringify(pins);
    if (state === this.state) return;
    this.state = state;
    this.element.replaceChildren(...pins.map((pin, number) => this.row(pin, number)));
    this.element.hidden = !pins.length;
  }
  row(pin, number) {
    const name = element("input", { type: "text", value: pin.name, maxlength: 40, "aria-label": say("Name of a pinned state"), title: say("Name of a pinned state") });
    name.addEventListener("change", () => this.change({ id: pin.id, name: name.value.trim() || pin.name }));
    const line = element("span", { class: "pin-line", "aria-hidden": "true" });
    line.innerHTML = `<svg viewBox="0 0 30 8"><path d="M0 4H30" stroke-dasharray="${DASHES[number % DASHES.length]}"/></svg>`;
    const gone = element("button", { type: "button", class: "remove", onclick: () => this.change({ id: pin.id }), "aria-label": say("Unpin {0}", pin.name), title: say("Unpin {0}", pin.name) }, "×");
    return element("li", {}, line, name, gone);
  }
}
