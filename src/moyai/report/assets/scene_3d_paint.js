// How a 3-D scene looks: far things first, what is under water seen through the surface.
"use strict";

const LAYERS_3D = 14, TONES_3D = 16;

Object.assign(Scene3D.prototype, {
  paint(pen, width, height, t, view) {
    const started = performance.now(), theme = MOYAI.theme(MOYAI.printing), s = MOYAI.style;
    const paper = { water: s("--water"), line: s("--water-line"), bed: s("--bed"), hull: s("--hull"), sheet: s("--sheet"), buoy: s("--buoy") };
    Object.assign(this, { pen, theme, paper, t, width, height });
    this.font = getComputedStyle(document.body).fontFamily;
    this.light = MOYAI.luminance(theme.page) > 0.4;
    const strip = this.traces.length ? 74 : 8;
    this.strip = this.traces.length ? [48, height - strip, width - 62, strip - 24] : null;
    const area = [16, 34, width - 32, height - strip - 52];
    this.seek(t);
    this.aim(view, area);
    pen.fillStyle = theme.page;
    pen.fillRect(0, 0, width, height);
    pen.save();
    pen.beginPath(); pen.rect(0, 0, width, height - strip); pen.clip();
    pen.lineCap = pen.lineJoin = "round";
    this.projectNodes();
    if (this.hasSurface) this.makeSurface();
    const above = this.camera.pitch >= 0;
    if (above) { this.paintBed(); this.paintWalls(); this.paintShadow(); }
    const sides = this.sortThings();
    this.paintThings(sides[above ? 0 : 1]);
    if (this.hasSurface) this.paintSurface();
    this.paintThings(sides[above ? 1 : 0]);
    if (!above) this.paintBed();
    this.paintEdges();
    this.paintArrows();
    pen.restore();
    this.paintWords(view, area);
    if (this.strip) this.paintStrip();
    this.paintHover();
    if (this.viewButtons) for (const b of this.viewButtons) b.setAttribute("aria-pressed", String(b.value === view));
    this.slow = 0.8 * this.slow + 0.2 * (performance.now() - started);
  },
  projectNodes() {
    const { camera: c, place: p, screen: o } = this, [mx, my, mz] = c.middle, [rx, ry, rz] = c.right, [ax, ay, az] = c.away, [ux, uy, uz] = c.up;
    for (let i = 0; i < p.length; i += 3) {
      const x = p[i] - mx, y = p[i + 1] - my, z = p[i + 2] - mz, d = x * ax + y * ay + z * az;
      const k = c.parallel ? c.scale : (c.scale * c.distance) / Math.max(c.distance + d, 0.05 * c.distance);
      o[i] = c.cx + k * (x * rx + y * ry + z * rz);
      o[i + 1] = c.cy - k * (x * ux + y * uy + z * uz);
      o[i + 2] = d;
    }
  },
  polygon(points) {
    this.pen.beginPath();
    for (const p of points) this.pen.lineTo(p[0], p[1]);
    this.pen.closePath();
  },

  // ---- surroundings
  paintBed() {
    if (!this.hasBed) return;
    const { pen, paper, theme, scene: { bed } } = this, { low, high } = this.display;
    const corners = [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]].map(([x, y]) => this.project(x, y, bed));
    this.polygon(corners);
    if (this.camera.pitch >= 0) {
      pen.globalAlpha = this.light ? 0.5 : 0.75;
      pen.fillStyle = paper.bed; pen.fill();
    }
    const size = MOYAI.niceStep(this.display.span / 7);
    this.gridSize = size;
    pen.strokeStyle = theme.ink; pen.lineWidth = 0.6; pen.globalAlpha = 0.16;
    pen.beginPath();
    for (const [i, j] of [[0, 1], [1, 0]]) {
      for (let v = Math.ceil(low[i] / size) * size; v <= high[i]; v += size) {
        const a = [0, 0], b = [0, 0];
        a[i] = b[i] = v; a[j] = low[j]; b[j] = high[j];
        const p = this.project(a[0], a[1], bed), q = this.project(b[0], b[1], bed);
        pen.moveTo(p[0], p[1]); pen.lineTo(q[0], q[1]);
      }
    }
    pen.stroke();
    pen.globalAlpha = 0.75; pen.lineWidth = 1; pen.strokeStyle = theme.muted;
    this.polygon(corners); pen.stroke();
    pen.globalAlpha = 1;
  },
  // Upright projections on the bed tell where things stand.
  paintShadow() {
    if (!this.hasBed || this.camera.pitch < 0.05 || this.bars.length > 6000) return;
    const { pen, place: p, bars: b, scene: { bed } } = this;
    pen.beginPath();
    for (let k = 0; k < b.length; k += 2) {
      const i = 3 * b[k], j = 3 * b[k + 1], from = this.project(p[i], p[i + 1], bed), to = this.project(p[j], p[j + 1], bed);
      pen.moveTo(from[0], from[1]); pen.lineTo(to[0], to[1]);
    }
    pen.globalAlpha = 0.13; pen.strokeStyle = "#000"; pen.lineWidth = 2.4; pen.stroke();
    pen.globalAlpha = 1;
  },
  // Heights of the surface on a grid fine enough for the waves, coarser while the machine cannot keep up.
  makeSurface() {
    const { low, high } = this.display, wide = [high[0] - low[0], high[1] - low[1]], most = this.slow > 45 ? 600 : 1600;
    const wave = this.waves && this.waves.length ? this.waves.length / 14 : Math.max(...wide) / 26;
    let cell = Math.max(Math.min(wave, Math.max(...wide) / 12), Math.max(...wide) / 90);
    cell = Math.max(cell, Math.sqrt((wide[0] * wide[1]) / most));
    const nx = Math.max(2, Math.round(wide[0] / cell)), ny = Math.max(2, Math.round(wide[1] / cell));
    const z = new Float32Array((nx + 1) * (ny + 1)), points = new Array(z.length);
    for (let j = 0, n = 0; j <= ny; j++) for (let i = 0; i <= nx; i++, n++) {
      const x = low[0] + (wide[0] * i) / nx, y = low[1] + (wide[1] * j) / ny;
      z[n] = this.elevation(x, y, this.t);
      points[n] = this.project(x, y, z[n]);
    }
    this.sea = { nx, ny, z, points, dx: wide[0] / nx, dy: wide[1] / ny };
  },
  surfaceAt(x, y) {
    if (!this.hasSurface) return 0;
    const { nx, ny, z, dx, dy } = this.sea, { low } = this.display;
    const i = Math.max(0, Math.min(nx - 1, Math.floor((x - low[0]) / dx))), j = Math.max(0, Math.min(ny - 1, Math.floor((y - low[1]) / dy)));
    const u = Math.max(0, Math.min(1, (x - low[0]) / dx - i)), v = Math.max(0, Math.min(1, (y - low[1]) / dy - j)), n = j * (nx + 1) + i;
    return (1 - v) * ((1 - u) * z[n] + u * z[n + 1]) + v * ((1 - u) * z[n + nx + 1] + u * z[n + nx + 2]);
  },
  side(number) {
    const { nx, ny, points } = this.sea, row = nx + 1;
    if (number === 0) return points.slice(0, row);
    if (number === 1) return Array.from({ length: ny + 1 }, (_, j) => points[j * row + nx]);
    if (number === 2) return points.slice(ny * row).reverse();
    return Array.from({ length: ny + 1 }, (_, j) => points[(ny - j) * row]);
  },
  // The far walls of the body of water, so that its depth shows.
  paintWalls() {
    if (!this.hasSurface) return;
    const { pen, paper, camera: c } = this, { low, high } = this.display, normals = [[0, -1], [1, 0], [0, 1], [-1, 0]];
    const corners = [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]];
    for (let n = 0; n < 4; n++) {
      if (normals[n][0] * c.away[0] + normals[n][1] * c.away[1] <= 1e-6) continue;
      const [a, b] = [corners[n], corners[(n + 1) % 4]], top = this.side(n), foot = [this.project(b[0], b[1], low[2]), this.project(a[0], a[1], low[2])];
      this.polygon([...top, ...foot]);
      const fade = pen.createLinearGradient(0, top[0][1], 0, foot[1][1]);
      fade.addColorStop(0, MOYAI.faded(paper.water, 0.85));
      fade.addColorStop(1, MOYAI.faded(paper.water, this.hasBed ? 0.55 : 0.05));
      pen.fillStyle = fade; pen.fill();
    }
  },
  paintSurface() {
    const { pen, paper, sea: { nx, ny, z, points, dx, dy } } = this, row = nx + 1, flat = !this.waves;
    const tones = Array.from({ length: 15 }, () => []);
    const steep = flat ? 1 : Math.max(1e-9, this.steepest());
    pen.beginPath();
    for (let j = 0; j < ny; j++) for (let i = 0; i < nx; i++) {
      const n = j * row + i, a = points[n], b = points[n + 1], c = points[n + row + 1], d = points[n + row];
      pen.moveTo(a[0], a[1]); pen.lineTo(b[0], b[1]); pen.lineTo(c[0], c[1]); pen.lineTo(d[0], d[1]); pen.closePath();
      if (flat) continue;
      const slope = ((z[n + 1] - z[n]) / dx + 0.6 * (z[n + row] - z[n]) / dy) / steep;
      tones[Math.max(0, Math.min(14, Math.round(7 - 7 * slope)))].push(n);
    }
    pen.fillStyle = paper.water; pen.globalAlpha = this.light ? 0.36 : 0.46; pen.fill();
    for (let k = 0; k < 15; k++) {
      if (!tones[k].length || k === 7) continue;
      pen.beginPath();
      for (const n of tones[k]) {
        const a = points[n], b = points[n + 1], c = points[n + row + 1], d = points[n + row];
        pen.moveTo(a[0], a[1]); pen.lineTo(b[0], b[1]); pen.lineTo(c[0], c[1]); pen.lineTo(d[0], d[1]); pen.closePath();
      }
      pen.fillStyle = k > 7 ? "#ffffff" : paper.line; pen.globalAlpha = Math.abs(k - 7) * (k > 7 ? 0.05 : 0.034) * (this.light ? 1 : 0.5); pen.fill();
    }
    pen.globalAlpha = 0.2; pen.strokeStyle = paper.line; pen.lineWidth = 0.6;
    pen.beginPath();
    const every = Math.max(1, Math.round(Math.max(nx, ny) / 24));
    for (let j = 0; j <= ny; j += every) for (let i = 0; i <= nx; i++) { const p = points[j * row + i]; if (i) pen.lineTo(p[0], p[1]); else pen.moveTo(p[0], p[1]); }
    for (let i = 0; i <= nx; i += every) for (let j = 0; j <= ny; j++) { const p = points[j * row + i]; if (j) pen.lineTo(p[0], p[1]); else pen.moveTo(p[0], p[1]); }
    pen.stroke();
    pen.globalAlpha = 1;
  },
  steepest() {
    if (this.steepestSlope === undefined) {
      const v = this.waves;
      this.steepestSlope = v.track ? 0 : Math.sqrt(v.a.reduce((sum, a, i) => sum + a * a * (v.kx[i] ** 2 + v.ky[i] ** 2), 0)) * (v.a.length > 1 ? 1.8 : 1);
      if (v.track) for (let k = 1; k < v.x.length; k++) this.steepestSlope = Math.max(this.steepestSlope, Math.abs((v.track.values[k] - v.track.values[k - 1]) / (v.x[k] - v.x[k - 1])));
    }
    return this.steepestSlope;
  },
  paintEdges() {
    if (!this.hasSurface) return;
    const { pen, paper } = this, { low, high } = this.display;
    pen.strokeStyle = paper.line; pen.lineWidth = 1.3; pen.globalAlpha = 0.85;
    pen.beginPath();
    for (let n = 0; n < 4; n++) this.side(n).forEach((p, i) => (i ? pen.lineTo(p[0], p[1]) : pen.moveTo(p[0], p[1])));
    pen.stroke();
    pen.globalAlpha = 0.3; pen.lineWidth = 0.8;
    pen.beginPath();
    for (const [x, y] of [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]]) {
      const p = this.project(x, y, this.surfaceAt(x, y)), q = this.project(x, y, low[2]);
      pen.moveTo(p[0], p[1]); pen.lineTo(q[0], q[1]);
    }
    pen.stroke();
    pen.globalAlpha = 1;
  },

  // ---- things: faces, bars and bodies by depth, apart for below and above the surface
  sortThings() {
    const { screen: s, place: p, bars: b } = this, radius = this.display.radius, sides = [[], []];
    const layer = (depth) => Math.max(0, Math.min(LAYERS_3D - 1, Math.floor(((radius - depth) / (2 * radius)) * LAYERS_3D)));
    const wet = (x, y, z) => (this.hasSurface && z < this.surfaceAt(x, y) + 1e-9 ? 0 : this.hasSurface || z > 0 ? 1 : 0);
    for (const side of sides) for (let k = 0; k < LAYERS_3D; k++) side.push({ bars: new Map(), solid: [] });
    for (let k = 0; k < b.length / 2; k++) {
      const i = 3 * b[2 * k], j = 3 * b[2 * k + 1], level = this.level[k];
      const at = wet(0.5 * (p[i] + p[j]), 0.5 * (p[i + 1] + p[j + 1]), 0.5 * (p[i + 2] + p[j + 2]));
      const tone = level < 1 ? 0 : 1 + Math.min(TONES_3D - 2, Math.floor(((level - 1) / 254) * (TONES_3D - 1)));
      const mark = tone + (this.thin && this.thin[k] ? 100 : 0), { bars } = sides[at][layer(0.5 * (s[i + 2] + s[j + 2]))];
      if (bars.has(mark)) bars.get(mark).push(i, j); else bars.set(mark, [i, j]);
    }
    for (const faces of this.faces) {
      const c = faces.corners, now = this.now, count = faces.nodes.length / c;
      for (let k = 0; k < count; k++) {
        let x = 0, y = 0, z = 0, d = 0;
        const nodes = faces.nodes.subarray(c * k, c * k + c);
        for (const n of nodes) { x += p[3 * n]; y += p[3 * n + 1]; z += p[3 * n + 2]; d += s[3 * n + 2]; }
        const load = faces.levels ? faces.levels[now.i * count + k] * (1 - now.u) + faces.levels[(now.i + 1) * count + k] * now.u : -1;
        sides[wet(x / c, y / c, z / c)][layer(d / c)].solid.push({ depth: d / c, nodes, faces, load });
      }
    }
    for (const body of this.bodies) this.addBody(body, sides, layer, wet);
    for (const marker of this.scene.markers) {
      const i = 3 * marker.node, swims = marker.kind === "float" ? 0.3 * marker.diameter : 0;
      sides[wet(p[i], p[i + 1], p[i + 2] + swims)][layer(s[i + 2] - 0.02 * radius)].solid.push({ depth: s[i + 2] - 0.02 * radius, marker });
    }
    for (const side of sides) for (const { solid } of side) if (solid.length > 1) solid.sort((u, v) => v.depth - u.depth);
    return sides;
  },
  addBody(body, sides, layer, wet) {
    const { i, u } = this.now, { columns, values } = body.pose, get = (c) => values[i * columns + c] * (1 - u) + values[(i + 1) * columns + c] * u;
    const pose = Array.from({ length: 12 }, (_, c) => get(c)), points = [];
    for (let n = 0; n < body.vertices.length; n += 3) {
      const v = [body.vertices[n], body.vertices[n + 1], body.vertices[n + 2]];
      points.push([0, 1, 2].map((r) => pose[r] + pose[3 + 3 * r] * v[0] + pose[4 + 3 * r] * v[1] + pose[5 + 3 * r] * v[2]));
    }
    for (const face of body.faces) {
      const corners = face.map((n) => points[n]), middle = [0, 1, 2].map((r) => corners.reduce((sum, q) => sum + q[r], 0) / corners.length);
      const shown = corners.map((q) => this.project(...q)), [a, b, c] = corners;
      const normal = [0, 1, 2].map((r) => (b[(r + 1) % 3] - a[(r + 1) % 3]) * (c[(r + 2) % 3] - a[(r + 2) % 3]) - (b[(r + 2) % 3] - a[(r + 2) % 3]) * (c[(r + 1) % 3] - a[(r + 1) % 3]));
      const depth = shown.reduce((sum, q) => sum + q[2], 0) / shown.length;
      sides[wet(...middle)][layer(depth)].solid.push({ depth, shown, shade: Math.abs(normal[2]) / (Math.hypot(...normal) || 1) });
    }
  },
  paintThings(side) {
    const { pen, screen: s, theme } = this;
    for (let k = 0; k < LAYERS_3D; k++) {
      const { bars, solid } = side[k], near = 0.62 + (0.38 * k) / (LAYERS_3D - 1);
      for (const thing of solid) {
        if (thing.marker) this.paintMarker(thing.marker, near);
        else if (thing.shown) this.paintBodyFace(thing);
        else this.paintFace(thing);
      }
      for (const mark of [...bars.keys()].sort((u, v) => u - v)) {
        const ends = bars.get(mark), thin = mark >= 100, tone = mark % 100, f = (tone - 0.5) / (TONES_3D - 1);
        pen.beginPath();
        for (let n = 0; n < ends.length; n += 2) { pen.moveTo(s[ends[n]], s[ends[n] + 1]); pen.lineTo(s[ends[n + 1]], s[ends[n + 1] + 1]); }
        pen.globalAlpha = thin ? 0.85 * near : near;
        if (tone === 0) { pen.strokeStyle = theme.muted; pen.lineWidth = thin ? 0.7 : 1.2; pen.setLineDash(thin ? [2, 2] : [3, 4]); } else { pen.strokeStyle = MOYAI.loadColour(f); pen.lineWidth = thin ? 0.7 + 1.5 * f : 1.7 + 2.6 * f; }
        pen.stroke();
        pen.setLineDash([]);
      }
    }
    pen.globalAlpha = 1;
  },
  paintFace({ nodes, faces, load }) {
    const { pen, screen: s, place: p, paper, camera: c } = this, net = faces.kind === "net", [i, j, k] = [3 * nodes[0], 3 * nodes[1], 3 * nodes[2]];
    const a = [p[j] - p[i], p[j + 1] - p[i + 1], p[j + 2] - p[i + 2]], b = [p[k] - p[i], p[k + 1] - p[i + 1], p[k + 2] - p[i + 2]];
    const n = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]], size = Math.hypot(...n) || 1;
    const facing = Math.abs(n[0] * (c.away[0] - 0.5 * c.right[0]) + n[1] * (c.away[1] - 0.5 * c.right[1]) + n[2] * (c.away[2] - 0.9)) / size;
    pen.beginPath();
    for (const m of nodes) pen.lineTo(s[3 * m], s[3 * m + 1]);
    pen.closePath();
    const colour = load > 0 ? MOYAI.loadColour(load / 255) : net ? paper.line : paper.sheet;
    pen.globalAlpha = net ? 0.16 : 0.62; pen.fillStyle = colour; pen.fill();
    if (!net) { // a stroke closes the seam to the neighbour, light and shade show the folds
      pen.globalAlpha = 0.35; pen.strokeStyle = colour; pen.lineWidth = 0.6; pen.stroke();
      pen.globalAlpha = 0.3 * Math.max(0, 1.1 - facing); pen.fillStyle = "#000"; pen.fill();
    }
    pen.globalAlpha = 1;
  },
  paintBodyFace({ shown, shade }) {
    const { pen, theme, paper } = this;
    this.polygon(shown);
    pen.globalAlpha = 0.9; pen.fillStyle = paper.hull; pen.fill();
    pen.globalAlpha = 0.16 * (1 - shade); pen.fillStyle = "#000"; pen.fill();
    pen.globalAlpha = 1; pen.strokeStyle = theme.ink; pen.lineWidth = 1.1; pen.stroke();
  },
  paintMarker(marker, near) {
    const { pen, screen: s, theme, paper, place: p } = this, i = 3 * marker.node, x = s[i], y = s[i + 1], { scale } = this.camera;
    const k = this.project(p[i], p[i + 1], p[i + 2])[3] || scale, r = Math.max(marker.kind === "float" ? 3.5 : 3, 0.5 * marker.diameter * k);
    pen.globalAlpha = Math.min(1, near + 0.15);
    pen.lineWidth = 1; pen.strokeStyle = theme.ink;
    pen.beginPath();
    if (marker.kind === "anchor") {
      pen.moveTo(x, y - 5); pen.lineTo(x + 5, y + 4); pen.lineTo(x - 5, y + 4); pen.closePath();
      pen.fillStyle = theme.ink; pen.fill();
    } else if (marker.kind === "driven") {
      pen.arc(x, y, 4.5, 0, 2 * Math.PI);
      pen.fillStyle = theme.page; pen.fill(); pen.lineWidth = 2; pen.strokeStyle = theme.accent; pen.stroke();
    } else if (marker.kind === "float" || marker.kind === "clump") {
      pen.arc(x, y, r, 0, 2 * Math.PI);
      const shine = pen.createRadialGradient(x - 0.35 * r, y - 0.4 * r, 0.1 * r, x, y, r), base = marker.kind === "float" ? paper.buoy : "#5a626c";
      shine.addColorStop(0, MOYAI.mixed(base, "#ffffff", 0.55)); shine.addColorStop(0.6, base); shine.addColorStop(1, MOYAI.mixed(base, "#000000", 0.35));
      pen.fillStyle = shine; pen.fill(); pen.lineWidth = 0.7; pen.stroke();
    } else {
      pen.arc(x, y, 2.4, 0, 2 * Math.PI);
      pen.fillStyle = theme.ink; pen.fill();
    }
    pen.globalAlpha = 1;
  },

  // ---- words and signs
  paintArrows() {
    const { pen, paper, theme, scene } = this, { low, high, span } = this.display, size = 0.13 * span, from = [low[0] + 0.03 * span, low[1] + 0.06 * span];
    if (!this.hasSurface) return;
    const arrows = [];
    if (this.waves && this.waves.height > 0) arrows.push(["waves", this.waves.heading]);
    if (Math.hypot(...scene.current) > 0) arrows.push(["current", Math.atan2(scene.current[1], scene.current[0])]);
    pen.font = `11px ${this.font}`; pen.textAlign = "left";
    if (this.camera.pitch < 0.1) { // edge on: flat signs, as long as they point along the picture
      arrows.forEach(([label, heading], n) => {
        const { right } = this.camera, long = 46 * (Math.cos(heading) * right[0] + Math.sin(heading) * right[1]), [x, y] = [70 + (long < 0 ? 46 : 0), 44 + 17 * n];
        if (Math.abs(long) < 12) return;
        const head = 8 * Math.sign(long);
        pen.strokeStyle = pen.fillStyle = label === "waves" ? paper.line : theme.accent; pen.lineWidth = 2;
        pen.beginPath(); pen.moveTo(x, y); pen.lineTo(x + long - head, y); pen.stroke();
        this.polygon([[x + long, y], [x + long - head, y - 4], [x + long - head, y + 4]]); pen.fill();
        pen.fillStyle = theme.ink; pen.textAlign = "right"; pen.fillText(MOYAI.say(label), 62, y + 4);
      });
      return;
    }
    const placed = [];
    arrows.forEach(([label, heading], n) => {
      const c = Math.cos(heading), sn = Math.sin(heading), lift = 0.015 * span, z = (x, y) => this.surfaceAt(x, y) + lift;
      const x = from[0] + (c < 0 ? size * -c : 0), y = from[1] + (sn < 0 ? size * -sn : 0) + n * 0.09 * span;
      if (y > high[1]) return;
      const P = (along, across) => { const u = x + along * c - across * sn, v = y + along * sn + across * c; return this.project(u, v, z(x, y)); };
      const w = 0.055 * size, head = 0.32 * size;
      this.polygon([P(0, -w), P(size - head, -w), P(size - head, -3 * w), P(size, 0), P(size - head, 3 * w), P(size - head, w), P(0, w)]);
      pen.fillStyle = label === "waves" ? paper.line : theme.accent; pen.globalAlpha = 0.9; pen.fill();
      if (label === "current") { pen.strokeStyle = theme.page; pen.lineWidth = 0.8; pen.stroke(); }
      const [tx, ty] = P(size, 0);
      let line = ty + 4; // words keep clear of each other where the arrows lie close
      for (const [px, py] of placed) if (Math.abs(px - tx) < 48 && Math.abs(py - line) < 13) line = py + (line < py ? -13 : 13);
      placed.push([tx, line]);
      pen.globalAlpha = 1; pen.fillStyle = theme.ink; pen.fillText(MOYAI.say(label), tx + 5, line);
    });
  },
  paintWords(view, area) {
    const { pen, theme, scene, camera: c, width } = this, { factor, unit } = scene;
    pen.font = `12px ${this.font}`; pen.fillStyle = theme.ink; pen.textAlign = "left"; pen.textBaseline = "alphabetic";
    if (!scene.still) pen.fillText(`t = ${this.t.toFixed(2)} s`, 12, 19);
    // legend of tension
    const long = Math.min(150, 0.25 * width), x = width - long - 16, y = 11;
    for (let k = 0; k < long; k++) { pen.fillStyle = MOYAI.loadColour(k / long); pen.fillRect(x + k, y, 1.5, 7); }
    pen.fillStyle = theme.muted; pen.font = `11px ${this.font}`;
    pen.fillText("0", x, y + 18); pen.textAlign = "right"; pen.fillText(`${MOYAI.number(scene.scale * factor)} ${unit}`, x + long, y + 18);
    pen.fillStyle = theme.ink; pen.fillText(MOYAI.say("tension"), x - 8, y + 8);
    pen.strokeStyle = theme.muted; pen.lineWidth = 1.2; pen.setLineDash([3, 4]);
    pen.beginPath(); pen.moveTo(x - 112, y + 4); pen.lineTo(x - 90, y + 4); pen.stroke(); pen.setLineDash([]);
    pen.fillText(MOYAI.say("slack"), x - 116, y + 8);
    let down = y + 34;
    for (const f of this.faces) if (f.load) { pen.fillStyle = theme.muted; pen.fillText(`${f.name}: ${MOYAI.say("to")} ${MOYAI.number(f.load.scale * f.load.factor)} ${MOYAI.pretty(f.load.unit)}`, x + long, down); down += 14; }
    // axes
    const [ox, oy] = [30, area[1] + area[3] + 4], axis = 20;
    pen.textAlign = "center"; pen.lineWidth = 1.3; pen.font = `italic 11px ${this.font}`;
    ["x", "y", "z"].forEach((name, i) => {
      const dx = axis * c.right[i], dy = -axis * c.up[i];
      if (Math.hypot(dx, dy) < 4) return;
      pen.strokeStyle = pen.fillStyle = theme.muted;
      pen.beginPath(); pen.moveTo(ox, oy); pen.lineTo(ox + dx, oy + dy); pen.stroke();
      pen.fillText(name, ox + 1.35 * dx, oy + 1.35 * dy + 4);
    });
    this.paintMeasure(c, area);
  },
  paintMeasure(c, area) {
    const { pen, theme } = this, y = area[1] + area[3] + 9;
    pen.font = `11px ${this.font}`; pen.textAlign = "left"; pen.fillStyle = pen.strokeStyle = theme.muted;
    if (!c.parallel) {
      if (this.hasBed) pen.fillText(`${MOYAI.say("grid")} ${Number(this.gridSize.toPrecision(6))} m`, 66, y);
      return;
    }
    const length = MOYAI.niceStep(110 / c.scale), long = length * c.scale;
    pen.lineWidth = 1.4;
    pen.beginPath(); pen.moveTo(66, y - 8); pen.lineTo(66, y - 4); pen.lineTo(66 + long, y - 4); pen.lineTo(66 + long, y - 8); pen.stroke();
    pen.fillText(`${Number(length.toPrecision(6))} m`, 72 + long, y);
  },
  // The tension over the part that is played, with the moment shown.
  paintStrip() {
    const { pen, theme, scene, t } = this, [x0, y0, w, h] = this.strip, { factor, unit } = scene, [a, b] = this.player ? this.player.span() : scene.window;
    let most = 0;
    for (const trace of this.traces) for (let k = 0; k < trace.time.length; k++) if (trace.time[k] >= a && trace.time[k] <= b && trace.tension[k] > most) most = trace.tension[k];
    most = most || 1;
    const X = (v) => x0 + ((v - a) / (b - a || 1)) * w, Y = (v) => y0 + h - (Math.max(0, v) / most) * (h - 3);
    pen.fillStyle = theme.page; pen.fillRect(0, y0 - 6, this.width, this.height - y0 + 6);
    pen.strokeStyle = theme.rule; pen.lineWidth = 1;
    pen.beginPath(); pen.moveTo(x0, y0); pen.lineTo(x0, y0 + h); pen.lineTo(x0 + w, y0 + h); pen.stroke();
    pen.save();
    pen.beginPath(); pen.rect(x0, y0 - 2, w, h + 4); pen.clip();
    this.traces.forEach((trace, n) => {
      pen.strokeStyle = theme.tones[n % theme.tones.length]; pen.lineWidth = 1.25;
      pen.beginPath();
      for (let k = 0; k < trace.time.length; k++) pen.lineTo(X(trace.time[k]), Y(trace.tension[k]));
      pen.stroke();
    });
    pen.restore();
    pen.strokeStyle = theme.ink; pen.lineWidth = 1; pen.globalAlpha = 0.6;
    pen.beginPath(); pen.moveTo(X(t), y0 - 2); pen.lineTo(X(t), y0 + h); pen.stroke(); pen.globalAlpha = 1;
    this.traces.forEach((trace, n) => {
      pen.beginPath(); pen.arc(X(t), Y(this.traceAt(trace, t)), 3.2, 0, 2 * Math.PI);
      pen.fillStyle = theme.tones[n % theme.tones.length]; pen.fill(); pen.strokeStyle = theme.page; pen.stroke();
    });
    pen.font = `11px ${this.font}`; pen.fillStyle = theme.muted; pen.textAlign = "right";
    pen.fillText(MOYAI.number(most * factor), x0 - 5, y0 + 8); pen.fillText(unit, x0 - 5, y0 + 22); pen.fillText("0", x0 - 5, y0 + h);
    const step = MOYAI.niceStep((b - a) / Math.max(3, w / 130));
    pen.textAlign = "center";
    for (let v = Math.ceil(a / step - 1e-9) * step; v <= b + 1e-9 * step; v += step) {
      pen.fillText(`${Number(v.toPrecision(8))}${v + step > b ? " s" : ""}`, Math.min(X(v), x0 + w - 8), y0 + h + 14);
      pen.strokeStyle = theme.rule; pen.beginPath(); pen.moveTo(X(v), y0 + h); pen.lineTo(X(v), y0 + h + 3); pen.stroke();
    }
  },
  paintHover() {
    if (!this.hover || this.hover.bar >= this.level.length) return;
    const { pen, theme, scene, screen: s, place: p, bars: b } = this, { bar, at } = this.hover, i = 3 * b[2 * bar], j = 3 * b[2 * bar + 1];
    const tension = this.tensionOf(bar), name = this.named ? scene.names[this.named[bar]] : MOYAI.say("bar");
    pen.strokeStyle = theme.ink; pen.lineWidth = 5; pen.globalAlpha = 0.35; pen.beginPath(); pen.moveTo(s[i], s[i + 1]); pen.lineTo(s[j], s[j + 1]); pen.stroke(); pen.globalAlpha = 1;
    const middle = [0, 1, 2].map((k) => MOYAI.number(0.5 * (p[i + k] + p[j + k])));
    const words = [name, tension > 0 ? `${MOYAI.number(tension * scene.factor)} ${scene.unit}` : MOYAI.say("slack"), `x ${middle[0]}, y ${middle[1]}, z ${middle[2]} m`];
    pen.font = `12px ${this.font}`;
    const wide = Math.max(...words.map((v) => pen.measureText(v).width)) + 16, x = Math.min(at[0] + 14, this.width - wide - 4), y = Math.max(4, Math.min(at[1] - 58, this.height - 64));
    pen.fillStyle = theme.page; pen.globalAlpha = 0.94; pen.fillRect(x, y, wide, 54); pen.globalAlpha = 1;
    pen.strokeStyle = theme.rule; pen.lineWidth = 1; pen.strokeRect(x, y, wide, 54);
    pen.textAlign = "left";
    words.forEach((v, k) => { pen.fillStyle = k === 1 ? theme.ink : theme.muted; pen.fillText(v, x + 8, y + 16 + 16 * k); });
  },
});

MOYAI.niceStep = (wanted) => {
  const ten = 10 ** Math.floor(Math.log10(Math.max(wanted, 1e-12)));
  return [5, 2, 1].map((m) => m * ten).find((m) => m <= wanted * 1.0001) || ten;
};
MOYAI.channels = (colour) => {
  const hex = colour.trim().replace("#", ""), whole = hex.length === 3 ? [...hex].map((c) => c + c).join("") : hex;
  return [0, 2, 4].map((k) => parseInt(whole.slice(k, k + 2), 16) || 0);
};
MOYAI.luminance = (colour) => { const [r, g, b] = MOYAI.channels(colour); return (0.3 * r + 0.59 * g + 0.11 * b) / 255; };
MOYAI.faded = (colour, alpha) => `rgba(${MOYAI.channels(colour).join(",")},${alpha})`;
MOYAI.mixed = (first, second, share) => {
  const a = MOYAI.channels(first), b = MOYAI.channels(second);
  return `rgb(${a.map((v, k) => Math.round(v + share * (b[k] - v))).join(",")})`;
};
