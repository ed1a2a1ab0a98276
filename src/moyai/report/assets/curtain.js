// Painter of a curtain that snaps taut: section, plan and the tension so far, from frames of both shapes.
"use strict";

class CurtainSnap {
  constructor(scene) {
    this.scene = scene;
    this.times = MOYAI.array(scene.times);
    this.tension = MOYAI.array(scene.tension);
    this.position = scene.position ? MOYAI.array(scene.position) : null;
    this.plan = new MOYAI.Track(scene.plan, this.times);
    this.section = scene.section ? new MOYAI.Track(scene.section, this.times) : null;
    this.maximum = Math.max(1e-12, ...this.tension.filter(Number.isFinite));
  }
  aspect(view) {
    if (view === "Section") return 0.52;
    return view === "Plan" ? 0.5 : 0.42;
  }
  load(place) { return this.tension[place.i] * (1 - place.u) + this.tension[place.i + 1] * place.u; }
  paint(pen, width, height, t, view) {
    const theme = MOYAI.theme(MOYAI.printing), place = MOYAI.placeInTime(this.times, t), load = this.load(place);
    pen.fillStyle = theme.page;
    pen.fillRect(0, 0, width, height);
    pen.font = `12px ${getComputedStyle(document.body).fontFamily}`;
    const strip = 64, top = 24, room = height - top - strip - 6;
    const both = view !== "Plan" && view !== "Section" && this.section;
    const middle = both ? Math.round(0.42 * width) : 0;
    if (this.section && view !== "Plan") this.paintSection(pen, [0, top, both ? middle - 6 : width, room], place, load, theme);
    if (view !== "Section" || !this.section) this.paintPlan(pen, [middle, top, width - middle, room], place, load, theme);
    this.paintStrip(pen, [10, height - strip, width - 20, strip - 18], t, theme);
    pen.textAlign = "left";
    pen.fillStyle = theme.ink;
    pen.fillText(`t = ${t.toFixed(2)} s`, 10, 16);
    pen.textAlign = "right";
    const { factor, unit } = this.scene, state = load > 1e-6 * this.maximum ? `${MOYAI.say("tension")} ${MOYAI.number(load * factor)} ${unit}` : MOYAI.say("slack");
    pen.fillStyle = load >= 0.995 * this.maximum ? MOYAI.style("--bad") : theme.ink;
    pen.fillText(state, width - 10, 16);
  }
  frame(pen, area, box) {
    const [x0, x1, z0, z1] = box, scale = Math.min(area[2] / (x1 - x0), area[3] / (z1 - z0));
    const left = area[0] + (area[2] - scale * (x1 - x0)) / 2, low = area[1] + (area[3] + scale * (z1 - z0)) / 2;
    return { X: (x) => left + (x - x0) * scale, Z: (z) => low - (z - z0) * scale, scale };
  }
  curve(pen, X, Z, p, load, theme) {
    const n = p.length / 2, fraction = load / this.maximum;
    pen.lineJoin = pen.lineCap = "round";
    pen.beginPath();
    for (let k = 0; k < n; k++) pen.lineTo(X(p[k]), Z(p[n + k]));
    pen.strokeStyle = load > 1e-6 * this.maximum ? MOYAI.loadColour(fraction) : theme.muted;
    pen.lineWidth = 2 + 2.6 * Math.max(0, Math.min(1, fraction));
    pen.stroke();
  }
  dot(pen, x, y, radius, fill, theme) {
    pen.beginPath(); pen.arc(x, y, radius, 0, 2 * Math.PI);
    pen.fillStyle = fill; pen.fill();
    pen.strokeStyle = theme.ink; pen.lineWidth = 1; pen.stroke();
  }
  arrow(pen, x, y, dx, dy, colour) {
    const size = Math.hypot(dx, dy) || 1, ux = dx / size, uy = dy / size;
    pen.strokeStyle = pen.fillStyle = colour;
    pen.lineWidth = 1.3;
    pen.beginPath(); pen.moveTo(x, y); pen.lineTo(x + dx, y + dy); pen.stroke();
    pen.beginPath();
    pen.moveTo(x + dx, y + dy); pen.lineTo(x + dx - 7 * ux - 3 * uy, y + dy - 7 * uy + 3 * ux); pen.lineTo(x + dx - 7 * ux + 3 * uy, y + dy - 7 * uy - 3 * ux);
    pen.fill();
  }
  paintSection(pen, area, place, load, theme) {
    const { bed } = this.scene, { X, Z } = this.frame(pen, area, this.scene.section_box), s = MOYAI.style;
    pen.save();
    pen.beginPath(); pen.rect(...area); pen.clip();
    const floor = bed === null ? area[1] + area[3] : Z(bed);
    pen.fillStyle = s("--water"); pen.fillRect(area[0], Z(0), area[2], floor - Z(0));
    pen.strokeStyle = s("--water-line"); pen.lineWidth = 1.5;
    pen.beginPath(); pen.moveTo(area[0], Z(0)); pen.lineTo(area[0] + area[2], Z(0)); pen.stroke();
    if (bed !== null) { pen.fillStyle = s("--bed"); pen.fillRect(area[0], floor, area[2], area[1] + area[3] - floor); }
    const p = this.section.at(place), n = p.length / 2;
    // the section stands where mid-span is: its shape moves with it
    pen.setLineDash([2, 4]); pen.strokeStyle = theme.muted; pen.lineWidth = 1;
    pen.beginPath(); pen.moveTo(X(0), Z(0)); pen.lineTo(X(0), Z(p[2 * n - 1])); pen.stroke(); pen.setLineDash([]);
    this.curve(pen, X, Z, p, load, theme);
    this.dot(pen, X(p[0]), Z(p[n]), 6, s("--buoy"), theme);
    this.dot(pen, X(p[n - 1]), Z(p[2 * n - 1]), 4, theme.ink, theme);
    this.arrow(pen, area[0] + 12, Z(0) + 22, 46, 0, s("--water-line"));
    pen.fillStyle = theme.ink; pen.textAlign = "left"; pen.fillText(MOYAI.say("section at mid-span"), area[0] + 10, area[1] + area[3] - 6);
    pen.restore();
  }
  paintPlan(pen, area, place, load, theme) {
    const s = MOYAI.style, { X, Z } = this.frame(pen, area, this.scene.plan_box);
    pen.save();
    pen.beginPath(); pen.rect(...area); pen.clip();
    pen.fillStyle = s("--water"); pen.fillRect(...area);
    // seen from above: y to the right, downstream downwards
    const p = this.plan.at(place), n = p.length / 2, turned = new Float64Array(2 * n);
    for (let k = 0; k < n; k++) { turned[k] = p[n + k]; turned[n + k] = -p[k]; }
    pen.setLineDash([2, 4]); pen.strokeStyle = theme.muted; pen.lineWidth = 1;
    pen.beginPath(); pen.moveTo(X(turned[0]), Z(0)); pen.lineTo(X(turned[n - 1]), Z(0)); pen.stroke(); pen.setLineDash([]);
    this.curve(pen, X, Z, turned, load, theme);
    for (const k of [0, n - 1]) this.dot(pen, X(turned[k]), Z(turned[n + k]), 5, s("--buoy"), theme);
    const y = area[1] + 12;
    for (const share of [0.2, 0.5, 0.8]) this.arrow(pen, area[0] + share * area[2], y, 0, 30, s("--water-line"));
    pen.fillStyle = theme.ink; pen.textAlign = "left"; pen.fillText(MOYAI.say("plan"), area[0] + 10, area[1] + area[3] - 6);
    pen.restore();
  }
  // The tension over the part that is played, with the moment shown.
  paintStrip(pen, area, t, theme) {
    const [x0, y0, w, h] = area, [a, b] = this.shown(t), X = (v) => x0 + ((v - a) / (b - a || 1)) * w, Y = (v) => y0 + h - (v / this.maximum) * h;
    pen.strokeStyle = theme.rule; pen.lineWidth = 1;
    pen.strokeRect(x0, y0, w, h);
    pen.strokeStyle = theme.muted; pen.lineWidth = 1.2;
    pen.beginPath();
    for (let k = 0; k < this.times.length; k++) if (this.times[k] >= a && this.times[k] <= b) pen.lineTo(X(this.times[k]), Y(this.tension[k]));
    pen.stroke();
    const place = MOYAI.placeInTime(this.times, t);
    pen.strokeStyle = theme.rule; pen.beginPath(); pen.moveTo(X(t), y0); pen.lineTo(X(t), y0 + h); pen.stroke();
    this.dot(pen, X(t), Y(this.load(place)), 3.5, MOYAI.loadColour(this.load(place) / this.maximum), theme);
    pen.fillStyle = theme.muted; pen.textAlign = "left"; pen.fillText(MOYAI.say("tension of both cables"), x0, y0 + h + 14);
    pen.textAlign = "right"; pen.fillText(`${a.toFixed(1)} ${MOYAI.say("to")} ${b.toFixed(1)} s`, x0 + w, y0 + h + 14);
  }
  shown(t) {
    const [a, b] = this.scene.window;
    return t >= a && t <= b ? [a, b] : [this.times[0], this.times[this.times.length - 1]];
  }
  readouts(t) {
    const place = MOYAI.placeInTime(this.times, t), theme = MOYAI.theme(false), { factor, unit } = this.scene, load = this.load(place);
    const rows = [{ label: MOYAI.say("tension, both cables"), value: `${MOYAI.number(load * factor)} ${unit}`, extreme: `${MOYAI.say("max")} ${MOYAI.number(this.maximum * factor)} ${unit}`, colour: MOYAI.loadColour(load / this.maximum) }];
    if (this.position) {
      const now = this.position[place.i] * (1 - place.u) + this.position[place.i + 1] * place.u;
      rows.push({ label: "mid-span downstream", value: `${MOYAI.number(now)} m`, extreme: `taut at ${MOYAI.number(this.scene.taut_position)} m`, colour: theme.ink });
    }
    return rows;
  }
}
MOYAI.painters["curtain-snap"] = CurtainSnap;
