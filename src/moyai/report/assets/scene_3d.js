// 3-D scene: data, camera and hands. What it looks like is in scene_3d_paint.js.
"use strict";

class Scene3D {
  constructor(scene) {
    this.scene = scene;
    this.tallest = 620;
    this.times = MOYAI.array(scene.times);
    const { nodes } = scene, levels = (coded) => MOYAI.unpack(coded.u1, Uint8Array);
    this.count = nodes.count;
    this.coded = MOYAI.unpack(nodes.i2, Int16Array);
    this.bars = Uint32Array.from(scene.bars);
    this.thin = scene.thin ? Uint8Array.from(scene.thin) : null;
    this.levels = levels(scene.tension);
    this.named = scene.named.length ? scene.named : null;
    this.faces = scene.faces.map((f) => ({ ...f, nodes: Uint32Array.from(f.nodes), levels: f.load ? levels(f.load.levels) : null }));
    this.bodies = scene.bodies.map((b) => ({ ...b, vertices: MOYAI.array(b.vertices), pose: MOYAI.quantised(b.pose) }));
    this.traces = scene.traces.map((t) => ({ ...t, time: MOYAI.array(t.time), tension: MOYAI.array(t.tension) }));
    this.place = new Float32Array(3 * this.count);
    this.screen = new Float32Array(3 * this.count); // x, y on the canvas and depth
    this.level = new Float32Array(this.bars.length / 2);
    this.readWaves(scene.waves);
    this.display = this.displayBox();
    this.yaw = scene.home[0];
    this.pitch = scene.home[1];
    this.zoom = 1;
    this.pan = [0, 0];
    this.fitted = null;
    this.shownView = null;
    this.hover = null;
    this.slow = 0;
  }
  readWaves(waves) {
    this.waves = null;
    if (!waves) return;
    if (waves.x) { this.waves = { x: MOYAI.array(waves.x), track: MOYAI.quantised(waves.elevation) }; return; }
    const [a, w, k, b, p] = ["amplitude", "omega", "wave_number", "heading", "phase"].map((n) => MOYAI.array(waves[n]));
    this.waves = { a, w, kx: Array.from(k, (v, i) => v * Math.cos(b[i])), ky: Array.from(k, (v, i) => v * Math.sin(b[i])), p, ramp: waves.ramp, height: 0 };
    for (const v of a) this.waves.height += v * v;
    this.waves.height = 2 * Math.sqrt(this.waves.height);
    let best = 0;
    for (let i = 1; i < a.length; i++) if (a[i] > a[best]) best = i;
    this.waves.heading = b[best];
    this.waves.length = k[best] > 0 ? (2 * Math.PI) / k[best] : 0;
  }
  // The box that is drawn: what moves, some room, the surface and the bed where they are near.
  displayBox() {
    const [low, high] = this.scene.box.map((p) => [...p]), size = high.map((v, i) => v - low[i]), most = Math.max(...size) || 1;
    const span = Math.max(size[0], size[1], 0.5 * most), { bed } = this.scene;
    for (const i of [0, 1]) {
      const room = Math.max(0.1 * span, 0.5 * (0.28 * span - size[i]));
      low[i] -= room; high[i] += room;
    }
    const rise = this.waves && this.waves.height ? this.waves.height : 0;
    this.hasSurface = this.scene.water && low[2] - 0.7 * most < 0 && -high[2] < 0.8 * most;
    this.hasBed = bed !== null && low[2] - bed < 0.9 * most;
    if (this.hasSurface) high[2] = Math.max(high[2], rise, 0.02 * most);
    low[2] = this.hasBed ? Math.min(bed, low[2]) : low[2] - 0.12 * most;
    return { low, high, middle: low.map((v, i) => 0.5 * (v + high[i])), radius: 0.5 * Math.hypot(...low.map((v, i) => high[i] - v)), span };
  }

  // ---- camera
  frameOf(view) {
    const fixed = { Side: [0, 0], End: [-Math.PI / 2, 0], Plan: [0, Math.PI / 2] }[view];
    const [yaw, pitch] = fixed || [this.yaw, this.pitch], c = Math.cos(yaw), s = Math.sin(yaw), u = Math.cos(pitch), v = Math.sin(pitch);
    return { right: [c, s, 0], away: [-u * s, u * c, -v], up: [-v * s, v * c, u], parallel: Boolean(fixed), pitch };
  }
  aim(view, area) {
    const { low, high, middle, radius } = this.display, f = this.frameOf(view), distance = 3.2 * radius;
    const mark = `${view} ${area.join()}`;
    if (view !== this.shownView) { this.zoom = 1; this.pan = [0, 0]; }
    if (!this.fitted || this.fitted.mark !== mark) {
      let x0 = Infinity, x1 = -Infinity, y0 = Infinity, y1 = -Infinity;
      for (let i = 0; i < 8; i++) {
        const r = [0, 1, 2].map((k) => ((i >> k) & 1 ? high[k] : low[k]) - middle[k]), dot = (v) => v[0] * r[0] + v[1] * r[1] + v[2] * r[2];
        const k = f.parallel ? 1 : distance / (distance + dot(f.away));
        x0 = Math.min(x0, k * dot(f.right)); x1 = Math.max(x1, k * dot(f.right));
        y0 = Math.min(y0, k * dot(f.up)); y1 = Math.max(y1, k * dot(f.up));
      }
      this.fitted = { mark, scale: Math.min(area[2] / (x1 - x0), area[3] / (y1 - y0)), x: 0.5 * (x0 + x1), y: 0.5 * (y0 + y1) };
    }
    this.shownView = view;
    const scale = this.fitted.scale * this.zoom;
    const cx = area[0] + 0.5 * area[2] - scale * this.fitted.x + this.pan[0], cy = area[1] + 0.5 * area[3] + scale * this.fitted.y + this.pan[1];
    this.camera = { ...f, scale, cx, cy, distance, middle };
    return this.camera;
  }
  project(x, y, z) {
    const c = this.camera, a = x - c.middle[0], b = y - c.middle[1], d = z - c.middle[2];
    const depth = a * c.away[0] + b * c.away[1] + d * c.away[2], k = c.parallel ? c.scale : (c.scale * c.distance) / Math.max(c.distance + depth, 0.05 * c.distance);
    return [c.cx + k * (a * c.right[0] + b * c.right[1]), c.cy - k * (a * c.up[0] + b * c.up[1] + d * c.up[2]), depth, k];
  }

  // ---- time
  seek(t) {
    const place = MOYAI.placeInTime(this.times, t), { i, u, h, before, after } = place, { offset, step } = this.scene.nodes, n = 3 * this.count, q = this.coded, out = this.place;
    const at = i * n, ahead = at + n, behind = before ? at - n : -1, beyond = after ? ahead + n : -1;
    const steps = this.times.length;
    for (let k = 0; k < n; k++) {
      const a = q[at + k], b = q[ahead + k];
      const sa = behind >= 0 ? (b - q[behind + k]) / before : (b - a) / h, sb = beyond >= 0 && i + 2 < steps ? (q[beyond + k] - a) / after : (b - a) / h;
      const value = a + u * (h * sa + u * (3 * (b - a) - h * (2 * sa + sb) + u * (2 * (a - b) + h * (sa + sb))));
      out[k] = offset[k % 3] + step[k % 3] * value;
    }
    const m = this.level.length, l = this.levels;
    for (let k = 0; k < m; k++) this.level[k] = l[i * m + k] * (1 - u) + l[(i + 1) * m + k] * u;
    this.now = place;
    return place;
  }
  tensionOf(bar) { return this.level[bar] < 1 ? 0 : ((this.level[bar] - 1) / 254) * this.scene.scale; }
  traceAt(trace, t) {
    const { i, u } = MOYAI.placeInTime(trace.time, t);
    return trace.tension[i] * (1 - u) + trace.tension[i + 1] * u;
  }
  elevation(x, y, t) {
    const v = this.waves;
    if (!v) return 0;
    if (v.track) {
      const { i, u } = this.now, n = v.x.length, place = MOYAI.placeInTime(v.x, x), get = (f, k) => v.track.values[f * n + k];
      const at = (f) => get(f, place.i) * (1 - place.u) + get(f, place.i + 1) * place.u;
      return at(i) * (1 - u) + at(i + 1) * u;
    }
    let sum = 0;
    for (let i = 0; i < v.a.length; i++) sum += v.a[i] * Math.cos(v.kx[i] * x + v.ky[i] * y - v.w[i] * t + v.p[i]);
    return v.ramp > 0 && t < v.ramp ? 0.5 * (1 - Math.cos((Math.PI * Math.max(t, 0)) / v.ramp)) * sum : sum;
  }
  readouts(t) {
    const { factor, unit } = this.scene, tones = MOYAI.theme(false).tones;
    return this.traces.map((trace, i) => {
      const used = (load) => (trace.breaking ? ` (${MOYAI.number((100 * load) / trace.breaking, 2)} %)` : "");
      const now = this.traceAt(trace, t);
      return { label: trace.name, value: now > 0 ? `${MOYAI.number(now * factor)} ${unit}${used(now)}` : MOYAI.say("slack"), extreme: `${MOYAI.say("max")} ${MOYAI.number(trace.maximum * factor)} ${unit}${used(trace.maximum)}`, colour: tones[i % tones.length] };
    });
  }
  aspect() { return 0.58; }

  // ---- hands: drag turns, two fingers or shift move and zoom, the wheel zooms once the picture has been clicked
  attach(player) {
    this.player = player;
    const { canvas } = player, fingers = new Map();
    canvas.style.touchAction = "none";
    canvas.style.cursor = "grab";
    this.addButtons(player);
    const where = (e) => { const b = canvas.getBoundingClientRect(); return [e.clientX - b.left, e.clientY - b.top]; };
    const seek = (p) => { const [x, , w] = this.strip, [a, b] = player.span(); player.pause(); player.seek(a + Math.max(0, Math.min(1, (p[0] - x) / w)) * (b - a)); };
    const inStrip = (p) => this.strip && p[1] >= this.strip[1] - 4 && p[1] <= this.strip[1] + this.strip[3] + 18;
    canvas.addEventListener("pointerdown", (e) => {
      const p = where(e);
      canvas.setPointerCapture(e.pointerId);
      player.holder.focus({ preventScroll: true });
      this.hover = null;
      if (inStrip(p) && fingers.size === 0) { this.seeking = true; seek(p); return; }
      fingers.set(e.pointerId, p);
      canvas.style.cursor = "grabbing";
    });
    canvas.addEventListener("pointermove", (e) => {
      const p = where(e);
      if (this.seeking) { seek(p); return; }
      const last = fingers.get(e.pointerId);
      if (!last) { if (e.pointerType === "mouse") this.pointAt(p); return; }
      const dx = p[0] - last[0], dy = p[1] - last[1];
      if (fingers.size >= 2) {
        const other = [...fingers].find(([id]) => id !== e.pointerId)[1], far = (q) => Math.hypot(q[0] - other[0], q[1] - other[1]);
        this.zoomBy(far(p) / Math.max(far(last), 1), [0.5 * (p[0] + other[0]), 0.5 * (p[1] + other[1])]);
        this.pan[0] += 0.5 * dx; this.pan[1] += 0.5 * dy;
      } else if (e.shiftKey || e.buttons === 4 || e.buttons === 2) { this.pan[0] += dx; this.pan[1] += dy; } else this.turn(dx, dy);
      fingers.set(e.pointerId, p);
      player.repaint();
    });
    const lift = (e) => { fingers.delete(e.pointerId); this.seeking = false; canvas.style.cursor = "grab"; };
    canvas.addEventListener("pointerup", lift);
    canvas.addEventListener("pointercancel", lift);
    canvas.addEventListener("pointerleave", () => { if (this.hover) { this.hover = null; player.repaint(); } });
    canvas.addEventListener("contextmenu", (e) => e.preventDefault());
    canvas.addEventListener("dblclick", (e) => { if (!inStrip(where(e))) this.home(); });
    canvas.addEventListener("wheel", (e) => {
      if (!e.ctrlKey && !player.holder.contains(document.activeElement)) return;
      e.preventDefault();
      this.zoomBy(Math.exp(-0.0015 * e.deltaY * (e.deltaMode ? 20 : 1)), where(e));
      player.repaint();
    }, { passive: false });
  }
  addButtons(player) {
    const group = player.element("span", { className: "segmented" });
    group.setAttribute("role", "group");
    group.setAttribute("aria-label", MOYAI.say("View (V)"));
    this.viewButtons = Object.keys(this.scene.extents).map((view) => player.element("button", { type: "button", textContent: MOYAI.say(view), value: view, onclick: () => { if (player.view === view) this.home(); player.view = view; player.repaint(); } }));
    group.append(...this.viewButtons);
    const zoom = (text, title, factor) => player.element("button", { type: "button", textContent: text, title, onclick: () => { this.zoomBy(factor, null); player.repaint(); } });
    const nearer = player.element("span", { className: "segmented" }, zoom("−", MOYAI.say("Farther"), 0.8), zoom("+", MOYAI.say("Nearer"), 1.25));
    player.viewButton.replaceWith(group, nearer);
    player.viewButton = player.element("button", {});
    if (this.scene.still) for (const part of [player.playButton, player.scrub, player.clock, player.speedSelect, player.spanButton, ...player.holder.querySelectorAll('[title="M"]')]) part.style.display = "none";
    player.readouts.before(player.element("p", { className: "hint player-hint", textContent: MOYAI.say(this.traces.length ? "Drag to turn, shift-drag to move, click and scroll to zoom, double-click to return; click the trace to go to a time." : "Drag to turn, shift-drag to move, click and scroll to zoom, double-click to return.") }));
  }
  turn(dx, dy) {
    const { player } = this;
    if (player.view !== "3-D") { // a drag leaves the fixed views where they stand
      const f = this.camera;
      this.yaw = Math.atan2(f.right[1], f.right[0]);
      this.pitch = f.pitch;
      player.view = "3-D";
    }
    this.yaw -= 0.008 * dx;
    this.pitch = Math.max(-0.25, Math.min(Math.PI / 2, this.pitch + 0.006 * dy));
  }
  zoomBy(factor, about) {
    const before = this.zoom;
    this.zoom = Math.max(0.4, Math.min(60, this.zoom * factor));
    const ratio = this.zoom / before, c = this.camera;
    if (!about) return;
    // what is under the pointer stays there
    this.pan[0] += (1 - ratio) * (about[0] - c.cx) - (1 - ratio) * this.fitted.scale * before * this.fitted.x;
    this.pan[1] += (1 - ratio) * (about[1] - c.cy) + (1 - ratio) * this.fitted.scale * before * this.fitted.y;
  }
  home() {
    [this.yaw, this.pitch] = this.scene.home;
    this.zoom = 1; this.pan = [0, 0]; this.fitted = null;
    this.player.repaint();
  }
  pointAt([x, y]) {
    const s = this.screen, b = this.bars;
    let best = 64, found = null;
    for (let k = 0; k < b.length / 2; k++) {
      const i = 3 * b[2 * k], j = 3 * b[2 * k + 1], dx = s[j] - s[i], dy = s[j + 1] - s[i + 1], size = dx * dx + dy * dy || 1e-9;
      const u = Math.max(0, Math.min(1, ((x - s[i]) * dx + (y - s[i + 1]) * dy) / size)), ex = s[i] + u * dx - x, ey = s[i + 1] + u * dy - y, d = ex * ex + ey * ey;
      if (d < best) { best = d; found = { bar: k, at: [x, y] }; }
    }
    const changed = (found && found.bar) !== (this.hover && this.hover.bar) || (found && !this.player.playing);
    this.hover = found;
    if (changed && !this.player.playing) this.player.repaint();
  }
}
MOYAI.painters["scene-3d"] = Scene3D;
