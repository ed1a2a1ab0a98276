// The list of the sections of the report: it goes to one of them, and names the one that is looked at.
import { element, say } from "/assets/server.js";

export class Sections {
  constructor(report) {
    this.report = report;
    this.element = element("select", { "aria-label": say("Go to a section"), onchange: () => { document.getElementById(this.element.value)?.scrollIntoView({ behavior: "instant" }); } });
    report.addEventListener("click", (event) => {
      const link = event.target.closest("a[href^='#']");
      if (link) { event.preventDefault(); document.getElementById(link.hash.slice(1))?.scrollIntoView(); }
    });
    document.addEventListener("scroll", this.follow = () => this.name(), { passive: true });
  }
  close() { document.removeEventListener("scroll", this.follow); }
  list() {
    const sections = [...this.report.querySelectorAll("section[id]")].map((one) => [one.id, one.querySelector("h2").textContent]);
    const state = JSON.stringify(sections);
    if (state === this.state) return;
    this.state = state;
    this.element.replaceChildren(...sections.map(([id, words]) => element("option", { value: id }, words)));
    this.name();
  }
  name() {
    if (document.activeElement === this.element) return;
    const line = innerHeight / 3, seen = [...this.report.querySelectorAll("section[id]")].filter((one) => one.getBoundingClientRect().top < line).pop();
    if (seen) this.element.value = seen.id;
  }
}
