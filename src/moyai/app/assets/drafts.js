// Drafts of an open case: what is asked for, one after the other. Newer answers replace older ones, never the reverse.
import { stream, tell } from "/assets/server.js";

const PATIENCE = 500; // ms after which a further request overtakes one on its way that has drawn nothing, at least
const SOON = 250; // ms that figures may take to be drawn before the text

export class Drafts {
  // `view` gives what is asked for (`wish`) and takes what comes: `hearChecked`, `hearDrawn`, `hearRefused`, `work`.
  constructor(address, view) {
    this.address = address;
    this.view = view;
    this.sequence = this.checked = this.drawn = this.flying = 0;
    this.tab = crypto.randomUUID();
  }
  close() {
    this.closed = true;
    clearTimeout(this.overtaking);
  }
  async send(gesture, patient = false) {
    this.gesture = gesture;
    // What is on its way is drawn first, so that a steady drag moves the figures all along
    const left = this.flying ? Math.max(PATIENCE, 2.5 * (this.pace || 0)) - (performance.now() - this.flying) : 0;
    if (left > 0) {
      this.again = true;
      clearTimeout(this.overtaking);
      this.overtaking = setTimeout(() => { if (this.again) this.send(this.gesture); }, left);
      return;
    }
    this.again = this.stale = false;
    const sequence = ++this.sequence, { typed, ...wish } = this.view.wish();
    this.flying = performance.now();
    this.view.work(true);
    try {
      await stream(`${this.address}/draft`, { ...wish, sequence, gesture, patient, tab: this.tab }, (said) => this.hear(said, wish.edits, typed));
    } catch (refused) {
      tell(refused.message);
      this.view.hearRefused(refused.message, wish);
    }
    this.catchUp();
    if (sequence !== this.sequence || this.closed) return;
    clearTimeout(this.overtaking);
    this.flying = 0;
    this.view.work(false);
    if (this.again) this.send(this.gesture);
    else if (this.stale) this.send(this.gesture, true); // another tab went before: its turn first
  }
  // Resolve when the server knows what was moved and typed.
  async known(gesture) {
    this.flying = 0;
    await Promise.race([this.send(gesture), new Promise((heard) => { this.heard = heard; })]);
    this.catchUp();
  }
  hear(said, edits, typed) {
    if (this.closed) return;
    if (said.message === "checked" && said.sequence >= this.checked) {
      this.checked = said.sequence;
      if (this.heard && said.sequence === this.sequence) this.heard();
      this.late = () => { if (said.sequence === this.checked) this.view.hearChecked(said, edits, typed, this.drawn < said.sequence); };
      if (said.faults.length) this.catchUp(); else setTimeout(() => this.catchUp(), SOON);
    } else if (said.message === "drawn" && said.sequence >= this.drawn && said.sequence >= this.checked) {
      this.drawn = said.sequence;
      this.view.hearDrawn(said);
      if (said.sequence === this.sequence && this.flying) {
        this.pace = performance.now() - this.flying;
        this.flying = 0;
        if (this.again) this.send(this.gesture);
      }
      setTimeout(() => this.catchUp(), 0);
    } else if (said.message === "stale") this.stale = said.sequence === this.sequence;
    else if (said.message === "not drawn" || said.message === "lost") { this.catchUp(); this.view.hearRefused(said.text, {}, said.faults); }
  }
  // Text, fields and marks follow the figures where those are there at once.
  catchUp() {
    const act = this.late;
    this.late = null;
    if (act) act();
  }
}
