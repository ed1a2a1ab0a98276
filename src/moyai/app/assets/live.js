// Draw a report that changes: figures keep their elements and their zoom, choices stay, what is on screen comes first.
export class Live {
  constructor(holder) {
    this.holder = holder;
    this.waiting = [];
    MOYAI.figures = new Map();
    MOYAI.players = [];
  }
  draw(html, data) {
    const fresh = document.createElement("template");
    fresh.innerHTML = html;
    const kept = this.choices(), opened = this.opened(), figures = new Map(), made = [];
    const looks = new Map(MOYAI.players.map((player) => [player.holder.dataset.scene, lookOf(player)]));
    MOYAI.data = data;
    for (const element of fresh.content.querySelectorAll("[data-figure]")) {
      const name = element.dataset.figure, old = MOYAI.figures.get(name);
      if (old && alike(old.spec, data.figures[name])) {
        renew(old, data.figures[name], element);
        element.replaceWith(old.element);
        figures.set(name, old);
      } else {
        if (old && old.drawn) Plotly.purge(old.plot);
        made.push(name);
        figures.set(name, element);
      }
    }
    for (const [name, old] of MOYAI.figures) if (!figures.has(name) && old.drawn) Plotly.purge(old.plot);
    this.holder.replaceChildren(fresh.content);
    for (const name of made) figures.set(name, new MOYAI.Figure(figures.get(name)));
    MOYAI.figures = figures;
    MOYAI.players = [];
    this.reopen(opened);
    for (const [group, label] of kept) this.choose(group, label);
    this.paint();
    MOYAI.players = [...this.holder.querySelectorAll(".player")].map((holder) => new MOYAI.Player(holder));
    for (const player of MOYAI.players) lookAgain(player, looks.get(player.holder.dataset.scene));
  }
  // Figures on the screen at once; the others one by one while nothing else is to be done.
  paint() {
    const at = (figure) => figure.plot.getBoundingClientRect();
    const shown = [...MOYAI.figures.entries()].filter(([, figure]) => MOYAI.isVisible(figure.plot));
    const near = ([, figure]) => { const box = at(figure); return box.bottom > 0 && box.top < innerHeight; };
    this.waiting = [];
    const now = shown.filter(near);
    this.waiting = shown.filter((one) => !near(one)).map(([, figure]) => figure);
    for (const [, figure] of now) figure.draw();
    const turn = this.turn = (this.turn || 0) + 1;
    const rest = () => {
      const figure = turn === this.turn && this.waiting.shift();
      if (!figure) return;
      if (MOYAI.isVisible(figure.plot)) figure.draw();
      later(rest);
    };
    later(rest);
  }
  choices() {
    return [...this.holder.querySelectorAll(".choice")].map((choice) => {
      const pane = [...choice.children].find((one) => one.classList.contains("pane") && !one.hidden);
      return [choice.dataset.group, pane ? pane.dataset.option : ""];
    });
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

const later = (act) => (window.requestIdleCallback ? requestIdleCallback(act, { timeout: 400 }) : setTimeout(act, 20));

const frame = (spec) => JSON.stringify([spec.abscissae.map((one) => one.key), spec.panels.length, Boolean(spec.slider), spec.categories.length > 0]);
const alike = (old, spec) => frame(old) === frame(spec);

function renew(figure, spec, element) {
  const zoomed = figure.range && JSON.stringify(figure.range) !== JSON.stringify(figure.spec.window || null);
  if (!zoomed) figure.range = undefined;
  figure.spec = spec;
  figure.cache.clear();
  figure.abscissa = spec.abscissae.find((one) => figure.abscissa && one.key === figure.abscissa.key) || spec.abscissae[0];
  figure.element.querySelector("figcaption").replaceWith(element.querySelector("figcaption"));
}
