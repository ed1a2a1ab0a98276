// An open case: sliders, form, text and the live report are views of one document, which lives in the server.
import { Drafts } from "/assets/drafts.js";
import { editorOf } from "/assets/editor.js";
import { Form } from "/assets/form.js";
import { watchJobs } from "/assets/jobs.js";
import { Live } from "/assets/live.js";
import { Pins } from "/assets/pins.js";
import { element, get, post, say, tell } from "/assets/server.js";
import { Sections } from "/assets/sections.js";
import { Sliders } from "/assets/sliders.js";
import { tabs } from "/assets/tabs.js";

const TYPING = 350; // ms of rest before a typed text is sent
const LOOK = 2000; // ms after which another tab or another program may have changed the case

export class CaseView {
  constructor(content, key) {
    this.address = `/api/cases/${key}`;
    this.content = content;
    this.drafts = new Drafts(this.address, this);
    this.edits = new Map();
    this.typed = this.taken = 0;
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
    this.notice = element("div", { class: "file-notice", role: "alert", hidden: true }, element("span", {}, say("Another program changed the file.")),
      button(say("Take the file"), () => this.settle(true)), button(say("Keep this text"), () => this.settle(false)));
    this.state = element("p", { class: "quiet state", role: "status" }, say("drawing …"));
    this.report = element("div", { class: "report" });
    this.sections = new Sections(this.report);
    this.content.replaceChildren(
      element("div", { class: "controls" }, this.title,
        element("div", { class: "toolbar" }, button(say("Run"), () => this.run(), say("Full run as a job, with the report")), this.undoButton, pin,
          this.saveButton, element("a", { href: `${this.address}/case.yaml`, download: true }, say("Take the case"))),
        this.notice, this.pins.element, tabs((name) => this.showTab(name)), this.sliders.element, this.form.element, this.editor.element),
      element("div", { class: "look" }, element("div", { class: "top" }, this.state, this.sections.element), this.report));
    this.live = new Live(this.report);
    this.keys = (event) => { if (event.altKey && event.key.toLowerCase() === "z") { event.preventDefault(); this.undo(); } };
    document.addEventListener("keydown", this.keys);
    this.look = setInterval(this.seen = () => (document.hidden ? this.known() : this.refresh()), LOOK);
    document.addEventListener("visibilitychange", this.seen);
    this.take(record);
    this.drafts.send("opened");
  }
  showTab(name) {
    this.content.dataset.tab = this.tab = name;
    if (name === "form") this.form.renew();
  }
  // What was moved and typed here is known to the server first, also when the page is left.
  async known() {
    this.drafts.catchUp();
    clearTimeout(this.timer);
    if (this.dirty || this.edits.size) await this.drafts.known(this.dirty ? "typing" : this.drafts.gesture);
  }
  async ask(what, body) {
    await this.known();
    const typed = this.typed, record = await post(`${this.address}/${what}`, body);
    if (typed === this.typed) this.take(record);
    else tell(say("the text was changed meanwhile: do it again"));
  }
  async change(wish) {
    await this.ask("change", wish);
    this.form.renew();
    this.drafts.send(`form ${wish.path.join(".")}`);
  }
  async undo() {
    await this.ask("undo");
    this.drafts.send("undo");
  }
  async pin(wish) {
    await this.ask("pin", wish);
    this.drafts.send("pin");
  }
  async settle(take) {
    await this.ask("file", { take });
    this.drafts.send("file");
  }
  async save() {
    try {
      await this.ask("save");
    } catch (refused) {
      const name = prompt(`${refused.message}\n${say("Save under another name:")}`, this.name);
      if (!name) return;
      await this.ask("save", { name });
    }
    tell(say("{0} is saved", this.name));
  }
  async run() {
    await this.known();
    await post("/api/jobs", { case: this.address.split("/").pop() });
    await watchJobs();
    location.hash = "#/jobs";
  }
  close() {
    if (this.live) this.known();
    this.closed = true;
    this.drafts.close();
    clearInterval(this.look);
    document.removeEventListener("visibilitychange", this.seen);
    document.removeEventListener("keydown", this.keys);
    if (this.live) { this.live.close(); this.sections.close(); }
    clearTimeout(this.timer);
  }
  take(record) {
    this.taken++;
    this.name = record.name;
    this.title.textContent = record.name;
    document.title = `${record.name} · moyai`;
    this.editor.text = record.text;
    this.undoButton.disabled = !record.can_undo;
    this.pinned = record.pins.length;
    this.pins.show(record.pins);
    this.saveButton.disabled = !record.unsaved;
    this.notice.hidden = record.file !== "changed";
  }
  // Follow what another tab or another program has changed, while nothing is under way here.
  async refresh() {
    const busy = () => document.hidden || this.closed || this.dirty || this.edits.size || this.drafts.flying || this.drafts.late;
    if (busy()) return;
    const state = () => [this.taken, this.typed, this.drafts.sequence].join(), before = state(), pins = this.pins.state;
    const record = await get(this.address).catch(() => null);
    if (!record || busy() || state() !== before) return;
    const other = record.text !== this.editor.text;
    this.take(record);
    if (!other && pins === this.pins.state) return;
    if (this.tab === "form") this.form.renew();
    this.drafts.send("other");
  }
  textChanged() {
    this.typed++;
    this.dirty = true;
    this.saveButton.disabled = false;
    this.edits.clear();
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.drafts.send("typing"), TYPING);
  }
  sliderMoved(path, number) {
    this.moved = performance.now();
    this.live.pause();
    this.report.dataset.whole = "";
    this.edits.set(path, number);
    const { label, unit } = this.sliders.rows.get(path).spec;
    this.lately = `${label} ${number} ${unit}`.trim();
    this.drafts.send(`slider ${path}`);
  }
  wish() {
    this.live.remember();
    const wish = { ...(this.dirty ? { text: this.editor.text } : {}), edits: Object.fromEntries(this.edits), shown: this.live.shown(), level: this.live.chosen.get("water-level") || "", typed: this.typed };
    this.dirty = false;
    return wish;
  }
  work(working) { this.state.classList.toggle("working", working); }
  hearRefused(words, wish, faults) {
    if ("text" in wish) this.dirty = true;
    if (faults) this.editor.show(faults, []);
    this.say(words || say("not drawn; what is shown is older than the text"), true);
  }
  hearChecked(said, edits, typed, drawing) {
    for (const [path, number] of Object.entries(edits)) if (this.edits.get(path) === number) this.edits.delete(path);
    if (typed === this.typed) this.editor.text = said.text;
    this.editor.show(said.faults, said.warnings);
    this.form.mark(said.faults);
    if (this.tab === "form") this.form.renew();
    if (said.sliders) this.sliders.show(said.sliders);
    this.undoButton.disabled = !said.can_undo;
    this.saveButton.disabled = !said.unsaved;
    if (!said.faults.length) { if (drawing) this.say(say("drawing …")); }
    else this.say(said.faults.length === 1 ? say("1 error in the case; what is shown is older than the text") : say("{0} errors in the case; what is shown is older than the text", said.faults.length), true);
  }
  hearDrawn(said) {
    this.report.headlines = said.headlines;
    this.live.draw(said.html, said.data, said.last);
    this.sections.list();
    const parts = [say("Draft of {0}", said.analyses.join(", ")), said.left_out ? say("without irregular seas") : "",
      said.nominal ? say("nominal numbers only (no band, range or comparison)") : "", say("in {0} s", said.seconds.toFixed(2))];
    this.say(`${parts.filter(Boolean).join(say(", "))}${say(". ")}${said.last ? say("Run computes the rest.") : say("More follows.")}`);
    this.report.dataset.sequence = said.sequence;
    this.report.dataset.whole = said.last ? "1" : "";
    if (this.moved) { this.report.dataset.latency = Math.round(performance.now() - this.moved); this.moved = 0; }
  }
  say(words, old = false) {
    this.state.textContent = words;
    this.report.classList.toggle("old", old);
  }
}
