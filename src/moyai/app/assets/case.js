// An open case: sliders, text and the live report are three views of one document. Newer answers replace older ones, never the reverse.
import { editorOf } from "/assets/editor.js";
import { Form } from "/assets/form.js";
import { watchJobs } from "/assets/jobs.js";
import { Live } from "/assets/live.js";
import { Pins } from "/assets/pins.js";
import { element, get, post, say, stream, tell } from "/assets/server.js";
import { Sliders } from "/assets/sliders.js";
import { tabs } from "/assets/tabs.js";

const PATIENCE = 500; // ms after which a further request overtakes one on its way that has drawn nothing, at least
const SOON = 250; // ms that figures may take to be drawn before the text
const TYPING = 350; // ms of rest before a typed text is sent

export class CaseView {
  constructor(content, key) {
    this.address = `/api/cases/${key}`;
    this.content = content;
    this.sequence = this.checked = this.drawn = this.flying = 0;
    this.edits = new Map();
    this.typed = 0;
    this.form = new Form((wish) => this.change(wish), this.address);
    this.pins = new Pins((wish) => this.pin(wish));
    this.sliders = new Sliders((path, number) => this.sliderMoved(path, number));
  }
  async open() {
    const [record, editor] = await Promise.all([get(this.address), editorOf({ changed: () => this.textChanged(), undo: () => this.undo(), keysAt: (path) => this.form.keysAt(path) })]);
    this.editor = editor;
    const button = (words, act, title) => element("button", { type: "button", onclick: act, title }, words);
    this.title = element("h1", {}, record.name);
    this.undoButton = button(say("Undo"), () => this.undo(), say("Back to the text before the last change (Alt+Z)"));
    const pin = button(say("Pin"), () => this.pin({ name: this.lately || say("state {0}", this.pinned + 1) }), say("Keep this state, faint under the next ones"));
    this.saveButton = button(say("Save"), () => this.save(), say("Write the text to its file"));
    this.state = element("p", { class: "quiet state", role: "status" }, say("drawing …"));
    this.report = element("div", { class: "report" });
    this.jump = element("select", { "aria-label": say("Go to a section"), onchange: () => { document.getElementById(this.jump.value)?.scrollIntoView({ behavior: "instant" }); } });
    this.content.replaceChildren(
      element("div", { class: "controls" }, this.title,
        element("div", { class: "toolbar" }, button(say("Run"), () => this.run(), say("Full run as a job, with the report")), this.undoButton, pin,
          this.saveButton, element("a", { href: `${this.address}/case.yaml`, download: true }, say("Take the case"))),
        this.pins.element, tabs((name) => this.showTab(name)), this.sliders.element, this.form.element, this.editor.element),
      element("div", { class: "look" }, element("div", { class: "top" }, this.state, this.jump), this.report));
    this.report.addEventListener("click", (event) => {
      const link = event.target.closest("a[href^='#']");
      if (link) { event.preventDefault(); document.getElementById(link.hash.slice(1))?.scrollIntoView(); }
    });
    this.live = new Live(this.report);
    this.keys = (event) => { if (event.altKey && event.key.toLowerCase() === "z") { event.preventDefault(); this.undo(); } };
    document.addEventListener("keydown", this.keys);
    this.take(record);
    this.send("opened");
  }
  showTab(name) {
    this.content.dataset.tab = this.tab = name;
    if (name === "form") this.form.renew();
  }
  async change(wish) {
    const typed = this.typed;
    this.catchUp();
    clearTimeout(this.timer);
    const record = await post(`${this.address}/change`, { ...wish, text: this.editor.text });
    if (typed !== this.typed) { tell(say("the text was changed meanwhile: do it again")); return; }
    this.edits.clear();
    this.typed++;
    this.take(record);
    this.form.renew();
    this.send(`form ${wish.path.join(".")}`);
  }
  close() {
    this.closed = true;
    document.removeEventListener("keydown", this.keys);
    if (this.live) this.live.close();
    clearTimeout(this.timer);
  }
  take(record) {
    this.name = record.name;
    this.title.textContent = record.name;
    document.title = `${record.name} · moyai`;
    this.editor.text = record.text;
    this.undoButton.disabled = !record.can_undo;
    this.pinned = record.pins.length;
    this.pins.show(record.pins);
    this.saveButton.disabled = !record.unsaved;
  }
  textChanged() {
    this.typed++;
    this.edits.clear();
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.send("typing"), TYPING);
  }
  sliderMoved(path, number) {
    this.moved = performance.now();
    this.live.pause();
    this.report.dataset.whole = "";
    this.edits.set(path, number);
    const { label, unit } = this.sliders.rows.get(path).spec;
    this.lately = `${label} ${number} ${unit}`.trim();
    this.send(`slider ${path}`);
  }
  async send(gesture) {
    this.gesture = gesture;
    // What is on its way is drawn first, so that a steady drag moves the figures all along
    const left = this.flying ? Math.max(PATIENCE, 2.5 * (this.pace || 0)) - (performance.now() - this.flying) : 0;
    if (left > 0) {
      this.again = true;
      clearTimeout(this.overtaking);
      this.overtaking = setTimeout(() => { if (this.again) this.send(this.gesture); }, left);
      return;
    }
    this.again = false;
    const sequence = ++this.sequence, edits = Object.fromEntries(this.edits), typed = this.typed, shown = this.live.shown();
    this.flying = performance.now();
    this.state.classList.add("working");
    this.live.remember();
    try {
      await stream(`${this.address}/draft`, { sequence, text: this.editor.text, edits, gesture, shown, level: this.live.chosen.get("water-level") || "" }, (said) => this.hear(said, edits, typed));
    } catch (refused) {
      tell(refused.message);
    }
    this.catchUp();
    if (sequence !== this.sequence) return;
    clearTimeout(this.overtaking);
    this.flying = 0;
    this.state.classList.remove("working");
    if (this.again) this.send(this.gesture);
  }
  hear(said, edits, typed) {
    if (this.closed) return;
    if (said.message === "checked" && said.sequence >= this.checked) {
      this.checked = said.sequence;
      this.late = () => { if (said.sequence === this.checked) this.hearChecked(said, edits, typed); };
      if (said.faults.length) this.catchUp(); else setTimeout(() => this.catchUp(), SOON);
    } else if (said.message === "drawn" && said.sequence >= this.drawn && said.sequence >= this.checked) this.hearDrawn(said);
    else if (said.message === "not drawn") { this.catchUp(); this.editor.show(said.faults, []); this.say(say("not drawn; what is shown is older than the text"), true); }
    else if (said.message === "lost") this.say(said.text, true);
  }
  // Text, fields and marks follow the figures where those are there at once.
  catchUp() {
    const act = this.late;
    this.late = null;
    if (act) act();
  }
  hearChecked(said, edits, typed) {
    for (const [path, number] of Object.entries(edits)) if (this.edits.get(path) === number) this.edits.delete(path);
    if (typed === this.typed) this.editor.text = said.text;
    this.editor.show(said.faults, said.warnings);
    this.form.mark(said.faults);
    if (this.tab === "form") this.form.renew();
    if (said.sliders) this.sliders.show(said.sliders);
    if (!said.faults.length) { this.say(say("drawing …")); this.undoButton.disabled = false; this.saveButton.disabled = false; }
    else this.say(said.faults.length === 1 ? say("1 error in the case; what is shown is older than the text") : say("{0} errors in the case; what is shown is older than the text", said.faults.length), true);
  }
  hearDrawn(said) {
    this.drawn = said.sequence;
    this.report.headlines = said.headlines;
    this.live.draw(said.html, said.data, said.last);
    this.listSections();
    const parts = [say("Draft of {0}", said.analyses.join(", ")), said.left_out ? say("without irregular seas") : "",
      said.nominal ? say("nominal numbers only (no band, range or comparison)") : "", say("in {0} s", said.seconds.toFixed(2))];
    this.say(`${parts.filter(Boolean).join(say(", "))}${say(". ")}${said.last ? say("Run computes the rest.") : say("More follows.")}`);
    this.report.dataset.sequence = said.sequence;
    this.report.dataset.whole = said.last ? "1" : "";
    if (said.sequence === this.sequence && this.flying) {
      this.pace = performance.now() - this.flying;
      this.flying = 0;
      if (this.again) this.send(this.gesture);
    }
    setTimeout(() => this.catchUp(), 0);
    if (this.moved) { this.report.dataset.latency = Math.round(performance.now() - this.moved); this.moved = 0; }
  }
  listSections() {
    const sections = [...this.report.querySelectorAll("section[id]")].map((one) => [one.id, one.querySelector("h2").textContent]);
    const state = JSON.stringify(sections);
    if (state === this.sections) return;
    this.sections = state;
    this.jump.replaceChildren(...sections.map(([id, words]) => element("option", { value: id }, words)));
  }
  say(words, old = false) {
    this.state.textContent = words;
    this.report.classList.toggle("old", old);
  }
  async undo() {
    this.edits.clear();
    this.typed++;
    this.take(await post(`${this.address}/undo`));
    this.send("undo");
  }
  async pin(wish) {
    this.take(await post(`${this.address}/pin`, wish));
    this.send("pin");
  }
  async save() {
    try {
      this.take(await post(`${this.address}/save`));
      tell(say("{0} is saved", this.name));
    } catch (refused) {
      const name = prompt(`${refused.message}\n${say("Save under another name:")}`, this.name);
      if (name) { this.take(await post(`${this.address}/save`, { name })); tell(say("{0} is saved", this.name)); }
    }
  }
  async run() {
    const key = this.address.split("/").pop();
    await post("/api/jobs", { case: key });
    await watchJobs();
    location.hash = "#/jobs";
  }
}
