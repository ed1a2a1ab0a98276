// Draw a report that changes: figures keep their elements and their zoom, choices stay, what is on screen comes first.
// A draft of a part leaves the other sections where they are, faded, until the whole answer is there.
import { alike, renewed, renewedWithin, renewFigure, settle } from "/assets/renew.js";
import { element, say } from "/assets/server.js";

export class Live {
  constructor(holder) {
    this.holder = holder;
    this.waiting = [];
    this.chosen = new Map();
    MOYAI.figures = new Map();
    MOYAI.players = [];
    this.scrolled = () => { if (this.waiting.some(near)) this.pause(60); };
    document.addEventListener("scroll", this.scrolled, { passive: true, capture: true });
    this.enlarged = () => this.fill();
    document.addEventListener("fullscreenchange", this.enlarged);
  }
  close() {
    clearTimeout(this.timer);
    document.removeEventListener("fullscreenchange", this.enlarged);
    document.removeEventListener("scroll", this.scrolled, { capture: true });
  }
  // Names of the sections and figures on the screen.
  shown() {
    return [...this.holder.querySelectorAll("section[id], [data-figure]")].filter(onScreen).map((one) => one.id);
  }
  // What is looked at stays where it is, whatever becomes longer or shorter above it.
  anchor() {
    if (!scrollY) return null;
    const seen = [...this.holder.querySelectorAll("[data-figure], section[id]")].map((one) => ({ id: one.id, top: one.getBoundingClientRect().top, element: one })).filter(({ element }) => onScreen(element));
    return seen.find(({ top }) => top >= 0) || seen.pop() || null;
  }
  draw(html, data, whole = true) {
    const fresh = document.createElement("template");
    fresh.innerHTML = html;
    this.remember();
    const held = this.anchor();
    const opened = this.opened(), figures = new Map(), made = [], older = whole ? [] : this.keep(fresh.content);
    for (const [name, old] of MOYAI.figures) if (older.some((section) => section.contains(old.element))) figures.set(name, old);
    const stays = (element) => older.some((section) => section.contains(element)), before = MOYAI.data;
    const players = MOYAI.players.filter((player) => stays(player.holder));
    const looks = new Map(MOYAI.players.filter((player) => !players.includes(player)).map((player) => [player.holder.dataset.scene, lookOf(player)]));
    MOYAI.data = older.length ? Object.fromEntries(Object.keys(data).map((key) => [key, { ...before[key], ...data[key] }])) : data;
    for (const element of fresh.content.querySelectorAll("[data-figure]")) {
      const name = element.dataset.figure, old = MOYAI.figures.get(name);
      if (old && alike(old.spec, data.figures[name])) {
        renewFigure(old, data.figures[name], element);
        element.kept = old;
        figures.set(name, old);
      } else {
        if (old && old.drawn) Plotly.purge(old.plot);
        made.push(name);
        figures.set(name, element);
      }
    }
    for (const [name, old] of MOYAI.figures) if (!figures.has(name) && old.drawn) Plotly.purge(old.plot);
    if (older.length) this.place(fresh.content); else renewedWithin(this.holder, fresh.content);
    for (const name of made) figures.set(name, new MOYAI.Figure(figures.get(name)));
    MOYAI.figures = figures;
    MOYAI.players = [];
    this.reopen(opened);
    for (const [group, label] of this.chosen) this.choose(group, label);
    const now = held && document.getElementById(held.id);
    if (now) scrollBy({ top: now.getBoundingClientRect().top - held.top, behavior: "instant" });
    this.paint(whole);
    MOYAI.players = players;
    for (const holder of this.holder.querySelectorAll(".player")) {
      if (stays(holder)) continue;
      const player = new MOYAI.Player(holder);
      MOYAI.players.push(player);
      lookAgain(player, looks.get(holder.dataset.scene));
    }
    this.offer();
  }
  // A button on every figure and moving view that gives it the whole screen.
  offer() {
    for (const place of this.holder.querySelectorAll(".figure > .tools, .player > .transport")) {
      if (place.querySelector(".full")) continue;
      place.append(element("button", { type: "button", class: "full", onclick: () => {
        const one = place.closest(".figure, .animation");
        if (document.fullscreenElement) document.exitFullscreen(); else one.requestFullscreen();
      } }, say("Full screen")));
    }
  }
  fill() {
    const one = document.fullscreenElement, room = Math.max(200, innerHeight - 190);
    for (const figure of MOYAI.figures.values()) {
      const tall = figure.element === one ? room : 0;
      if ((figure.tall || 0) !== tall) { figure.tall = tall; figure.draw(); }
    }
    for (const player of MOYAI.players) {
      player.tall = one && one.contains(player.holder) ? room : 0;
      player.repaint();
    }
  }
  // Put the sections of a draft in the places of the older ones of their name; the others are not touched.
  place(content) {
    let before = null;
    for (const one of [...content.children]) {
      const old = one.id ? document.getElementById(one.id) : this.holder.querySelector(".badges");
      if (old) renewed(old, one); else if (before) before.after(one); else this.holder.append(one);
      before = old || one;
      settle(before);
    }
  }
  // Return the sections that a draft leaves out, faded, and give it the choices that it has no panes for.
  keep(content) {
    const older = [];
    for (const section of this.holder.querySelectorAll("section[id]")) {
      const now = content.getElementById(section.id);
      if (!now) {
        section.classList.add("older");
        older.push(section);
      } else {
        for (const choice of now.querySelectorAll(".choice:not(:has(> .chooser))")) {
          const chooser = section.querySelector(`.choice[data-group="${choice.dataset.group}"] > .chooser`)?.cloneNode(true), known = choice.firstElementChild.dataset.option;
          if (!chooser) continue;
          choice.prepend(chooser);
          for (const one of chooser.querySelectorAll(":is(button,option)")) {
            one.disabled = (one.dataset.option ?? one.value) !== known;
            if (one.dataset.option) one.setAttribute("aria-pressed", String(!one.disabled));
          }
        }
      }
    }
    return older;
  }
  // Figures on the screen at once; the others one by one when nothing has changed for a while.
  paint(whole) {
    const shown = [...MOYAI.figures.entries()].filter(([, figure]) => MOYAI.isVisible(figure.plot));
    this.waiting = [];
    const now = shown.filter(([, figure]) => near(figure));
    this.waiting = shown.filter(([, figure]) => !near(figure)).map(([, figure]) => figure);
    for (const [, figure] of now) figure.draw();
    this.pause(whole ? 150 : 1000);
  }
  // Draw what is out of sight after a rest; a slider that moves puts it off.
  pause(rest = 1000) {
    clearTimeout(this.timer);
    const turn = this.turn = (this.turn || 0) + 1;
    const next = () => {
      if (turn !== this.turn) return; // put off since
      const at = Math.max(0, this.waiting.findIndex((figure) => near(figure))), [figure] = this.waiting.splice(at, 1);
      if (!figure) return;
      if (MOYAI.isVisible(figure.plot)) figure.draw();
      this.timer = setTimeout(() => later(next), 0);
    };
    this.timer = setTimeout(next, rest);
  }
  remember() {
    for (const choice of this.holder.querySelectorAll(".choice")) {
      const panes = [...choice.children].filter((one) => one.classList.contains("pane")), pane = panes.find((one) => !one.hidden);
      if (pane && panes.length > 1) this.chosen.set(choice.dataset.group, pane.dataset.option);
    }
  }
  choose(group, label) {
    const draw = MOYAI.drawVisible;
    MOYAI.drawVisible = () => {};
    try { MOYAI.choose(group, label); } finally { MOYAI.drawVisible = draw; }
  }
  opened() { return new Map([...this.holder.querySelectorAll("details")].map((one) => [one.querySelector("summary")?.textContent, one.open])); }
  reopen(opened) {
    for (const one of this.holder.querySelectorAll("details")) {
      const words = one.querySelector("summary")?.textContent;
      if (opened.has(words)) one.open = opened.get(words);
    }
  }
}

// A moving view that is drawn anew keeps its time, its direction and its zoom.
const CAMERA = ["yaw", "pitch", "zoom", "pan", "shownView"];
function lookOf(player) {
  const { view, t, speed, whole, playing, painter } = player;
  player.pause();
  return { view, t, speed, whole, playing, camera: painter ? CAMERA.filter((name) => name in painter).map((name) => [name, painter[name]]) : [] };
}
function lookAgain(player, look) {
  if (!look || !player.painter || !(look.view in player.scene.extents)) return;
  const { view, speed, whole } = look;
  Object.assign(player, { view, speed, whole });
  Object.assign(player.painter, Object.fromEntries(look.camera));
  player.speedSelect.value = speed;
  player.seek(look.t);
  if (look.playing) player.play();
}

const near = (figure) => onScreen(figure.plot);
// What lies under the line that stays at the top is not seen.
const onScreen = (element) => {
  const box = element.getBoundingClientRect(), line = document.querySelector(".look > .top")?.getBoundingClientRect();
  return box.bottom > Math.max(0, line?.top < 1 ? line.bottom : 0) && box.top < innerHeight;
};
const later = (act) => (window.requestIdleCallback ? requestIdleCallback(act, { timeout: 400 }) : setTimeout(act, 20));
