// The form of the case: groups and fields as the server made them from the schema. Every change is an edit of the text.
import { element, faultWords, get, say } from "/assets/server.js";

export class Form {
  constructor(change, address) {
    this.address = address;
    this.change = change;
    this.open = new Map();
    this.element = element("div", { class: "form", role: "group", "aria-label": say("Form of the case") });
  }
  async renew() {
    const turn = this.turn = (this.turn || 0) + 1;
    try {
      const { form } = await get(`${this.address}/form`);
      if (turn !== this.turn) return;
      this.last = form;
      this.show(form);
    } catch (refused) {
      if (turn === this.turn && !this.last) this.refuse(refused.message);
    }
  }
  // Keys that the block at a path lacks.
  async keysAt(path) {
    if (!this.last) await this.renew();
    let group = this.last;
    for (const step of path) {
      const entries = group ? group.entries : [], at = entries.findIndex((one) => one.path[one.path.length - 1] === step);
      group = at < 0 ? null : entries[at];
    }
    return (group && group.absent) || [];
  }
  show(form) {
    const state = JSON.stringify(form);
    if (state === this.state) return;
    this.state = state;
    const held = this.element.contains(document.activeElement) ? document.activeElement.dataset.path : null, top = this.element.scrollTop;
    this.fields = new Map();
    this.element.replaceChildren(...form.entries.map((entry) => this.entry(entry, 0)), this.adding(form));
    this.mark(this.faults || []);
    if (held) this.element.querySelector(`[data-path="${CSS.escape(held)}"]`)?.focus({ preventScroll: true });
    this.element.scrollTop = top;
  }
  refuse(words) {
    this.state = "";
    this.element.replaceChildren(element("p", { class: "quiet" }, words));
  }
  entry(one, depth) { return one.entries ? this.group(one, depth) : this.field(one); }
  group(one, depth) {
    const open = this.open.get(one.dotted) ?? (depth === 0 && ["structure"].includes(one.dotted));
    const summary = element("summary", { title: one.help, "data-path": one.dotted }, one.label,
      element("span", { class: "count" }, one.entries.some((entry) => entry.entries) ? "" : one.entries.slice(0, 3).map((entry) => String(entry.value)).join(", ")));
    const made = element("details", { class: "form-group", open }, summary);
    made.addEventListener("toggle", () => { this.open.set(one.dotted, made.open); });
    const words = element("p", { class: "form-help", hidden: !one.help }, one.help || "");
    made.append(words, ...one.entries.map((entry) => this.entry(entry, depth + 1)),
      one.more ? element("p", { class: "quiet" }, say("{0} more in the text", one.more)) : "",
      one.absent.length || one.removable ? element("div", { class: "form-foot" }, this.adding(one), one.removable ? this.removing(one, say("Remove {0}", one.label)) : "") : "");
    this.fields.set(one.dotted, { element: made, place: words });
    return made;
  }
  field(one) {
    const id = `field-${one.dotted.replace(/\W+/g, "-")}`, help = `${id}-help`;
    const said = { id, "data-path": one.dotted, "aria-describedby": help };
    const set = (value) => this.send(one, { change: "set", path: one.path, value, quoted: one.quoted });
    let input;
    if (one.type === "truth") {
      input = element("input", { ...said, type: "checkbox", onchange: () => set(String(input.checked)) });
      input.checked = one.value === true;
    } else if (one.type === "choice") {
      const known = one.choices.includes(String(one.value)) ? one.choices : [String(one.value), ...one.choices];
      input = element("select", { ...said, onchange: () => set(input.value) }, ...known.map((word) => element("option", { value: word }, word)));
      input.value = String(one.value);
    } else {
      const list = one.choices.length ? element("datalist", { id: `${id}-list` }, ...one.choices.map((word) => element("option", { value: word }))) : null;
      input = element("input", { ...said, type: "text", value: one.value ?? "", spellcheck: "false", autocomplete: "off", list: list && list.id, "data-type": one.type,
        onchange: () => { if (input.value !== String(one.value)) set(input.value); } });
      if (list) input.append(list);
      if (list) this.lists = list;
    }
    const row = element("div", { class: "field" }, element("label", { for: id, title: one.help }, one.label), input, one.removable ? this.removing(one, say("Remove {0}", one.label), "×") : element("span"),
      element("span", { class: "field-help", id: help }, one.help || ""), element("span", { class: "field-fault", role: "alert" }));
    if (this.lists) { row.append(this.lists); this.lists = null; }
    this.fields.set(one.dotted, { element: row, input, place: row.querySelector(".field-fault") });
    return row;
  }
  removing(one, words, sign = "") {
    return element("button", { type: "button", class: sign ? "remove" : "", "aria-label": words, title: say("Remove {0} from the case", one.dotted), onclick: () => this.send(one, { change: "remove", path: one.path }) }, sign || say("Remove"));
  }
  adding(group) {
    if (!group.absent.length) return "";
    const select = element("select", { class: "adding", "aria-label": say("Add a key to {0}", group.label), "data-path": `${group.dotted}+` },
      element("option", { value: "" }, say("Add …")), ...group.absent.map((one) => element("option", { value: one.key, title: one.help }, `${one.key}${one.help ? ` · ${shortened(one.help)}` : ""}`)));
    select.addEventListener("change", () => {
      const one = group.absent.find((absent) => absent.key === select.value);
      if (!one) return;
      const name = group.dotted ? `${group.dotted}.${one.key}` : one.key;
      this.open.set(name, true);
      if (group.dotted) this.open.set(group.dotted, true);
      this.send(group, { change: "add", path: [...group.path, one.key], value: one.start, after: one.after });
      select.value = "";
    });
    return select;
  }
  async send(one, wish) {
    try {
      await this.change(wish);
    } catch (refused) {
      const place = this.fields.get(one.dotted)?.element.querySelector(".field-fault");
      if (place) place.textContent = (refused.faults || []).map((fault) => faultWords({ ...fault, path: "" })).join("\n") || refused.message;
      else throw refused;
    }
  }
  mark(faults) {
    this.faults = faults;
    if (!this.fields) return;
    for (const { element: row, input, place } of this.fields.values()) {
      row.classList.remove("faulty");
      if (input) { input.removeAttribute("aria-invalid"); place.textContent = ""; }
    }
    for (const fault of faults) {
      const found = this.fields.get(fault.path);
      if (found && found.input) {
        found.input.setAttribute("aria-invalid", "true");
        found.place.textContent = faultWords({ ...fault, path: "" });
      }
      // Groups around a fault are marked, so that it is found while they are folded
      for (let path = fault.path; path; path = path.replace(/(\.[^.[\]]+|\[\d+\]|^[^.[\]]+)$/, "")) this.fields.get(path)?.element.classList.add("faulty");
    }
  }
}

const shortened = (words) => (words.length > 60 ? `${words.slice(0, 57)}…` : words);
