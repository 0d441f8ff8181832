"use strict";
// Drawings of a run at a moment, and what moves them: of the page of a run and of the explorer.

const COLOUR = { ink: "", paper: "", soft: "", muted: "", line: "", grey: "", steel: "", light: "", blue: "", vermilion: "", purple: "", green: "", sky: "" };
function readColours() {   // those of the style sheet, which has a dark set
  const style = getComputedStyle(document.documentElement);
  for (const name of Object.keys(COLOUR)) COLOUR[name] = style.getPropertyValue(`--${name}`).trim();
}
const byId = (id) => document.getElementById(id);

const spoken = { words: {}, comma: false };   // words in the page's language, decimal commas
const W = (text) => spoken.words[text] || text;
const local = (text) => (spoken.comma ? text.replace(/(\d)\.(?=\d)/g, "$1,") : text);

const withMinus = (text) => text.replace(/-(?=[\d.])/g, "−");
// A value with three digits and the prefix to its unit that suits it; lengths from 0.1 µm to 1 mm in µm.
const PREFIXES = [[1e-9, "n"], [1e-6, "µ"], [1e-3, "m"], [1, ""], [1e3, "k"], [1e6, "M"], [1e9, "G"]];
function amount(value, unit) {
  const size = Math.abs(Number(value.toPrecision(3))), fitting = PREFIXES.filter(([least]) => size >= least * (1 - 1e-9));
  const [factor, prefix] = unit === "m" && size >= 1e-7 && size < 1e-3 ? [1e-6, "µ"] : size === 0 ? [1, ""] : fitting.pop() || PREFIXES[0];
  return `${(value / factor).toPrecision(3)} ${prefix}${unit}`;
}

// Degrees of a crank angle [rad] within the cycle of a scene, as the summary counts them, or less a whole cycle beyond the end of its axis,
// which begins at `cycle.from`; what is left beyond the end of a cycle that begins within the axis is at the beginning of the axis.
function angleInCycle(cycle, radians) {
  const begin = cycle.angle * 180 / Math.PI, length = cycle.degrees;
  const start = (((begin - cycle.from) % length) + length) % length;   // just before a whole cycle: its end, but for rounding
  const angle = radians * 180 / Math.PI - begin + (length - start < 1e-3 * length ? start - length : start);
  return cycle.from + (angle > 1.001 * length ? angle - length : angle);
}
const axisOf = (cycle) => [cycle.from, cycle.from + cycle.degrees];
// The first of the abscissae in a cycle that is at the beginning of the axis again, -1 without one; and a list that begins with its value
// there, with a gap where the run's end meets its beginning.
const foldOf = (x, length) => x.findIndex((v, i) => i > 0 && v < x[i - 1] - length / 2);
const fromFold = (list, fold) => (fold < 0 ? list : [...list.slice(fold), null, ...list.slice(0, fold)]);
// The parts of an axis beyond a time; `x` gives the abscissa of a time, and the whole axis shows the times from `begin` to `end`.
function partsBeyond(time, begin, end, x, whole) {
  if (time === null || time >= end) return [];
  const [from, to] = [x(time), x(end)];
  return time <= begin ? [whole] : to > from ? [[from, to]] : [[from, whole[1]], [whole[0], to]];
}

// The drawing of a run on the canvases of the page: its scene, its columns by name, pressure and oil around the pin. `moved` is called
// after it has moved. With `others`, runs whose orbits are drawn behind in their `colour`, orbits are drawn whole; else up to the moment shown.
function drawingOf(scene, column, pressure, oil, moved = () => {}, others = null) {
  const time = column.time, begin = time[0], end = time[scene.rows - 1];
  const joint = scene.clearance > 0;
  const bore = scene.bore, crankPin = scene.crank_pin, smallEnd = scene.small_end, mainBearing = scene.main_bearing;
  document.body.classList.toggle("ideal", !joint);
  document.body.classList.toggle("boreless", !bore);
  document.body.classList.toggle("tight-crank-pin", !crankPin);
  document.body.classList.toggle("tight-small-end", !smallEnd);
  document.body.classList.toggle("tight-main-bearing", !mainBearing);
  const beside = 2 * joint + Boolean(smallEnd) + Boolean(crankPin) + Boolean(mainBearing) + Boolean(bore);   // views beside that of the mechanism
  document.body.classList.toggle("unmagnified", !beside);
  document.body.classList.toggle("single", !scene.engine);
  byId("twist-note").hidden = !(scene.engine && scene.engine.largest > 0);
  document.body.classList.toggle("contactless", scene.contacts.length === 0);
  document.body.classList.toggle("filmless", !scene.angles);
  document.body.classList.toggle("unsigned", !scene.signed);
  document.body.classList.toggle("cycleless", !scene.cycle);

  // ---- the moment shown
  let now = begin, row = 0, share = 0;
  const at = (name) => column[name][row] + share * (column[name][Math.min(row + 1, scene.rows - 1)] - column[name][row]);

  // Forces jump in contacts; therefore all forces are those of the nearest row.
  const nearest = () => (share > 0.5 ? Math.min(row + 1, scene.rows - 1) : row);
  const near = (name) => column[name][nearest()];

  function seek(t) {
    now = Math.min(Math.max(t, begin), end);
    let low = 0, high = scene.rows - 1;
    while (high - low > 1) { const middle = (low + high) >> 1; if (time[middle] <= now) low = middle; else high = middle; }
    row = low;
    share = time[high] > time[low] ? (now - time[low]) / (time[high] - time[low]) : 0;
    draw();
  }

  // ---- canvases in CSS pixels
  function prepare(id) {
    const canvas = byId(id), ratio = window.devicePixelRatio || 1;
    const width = canvas.clientWidth, height = canvas.clientHeight;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    const g = canvas.getContext("2d");
    g.setTransform(ratio, 0, 0, ratio, 0, 0);
    g.clearRect(0, 0, width, height);
    g.lineJoin = "round";
    return { g, width, height };
  }

  function circle(g, x, y, radius, fill, stroke, width) {
    g.beginPath();
    g.arc(x, y, Math.max(radius, 0), 0, 2 * Math.PI);
    if (fill) { g.fillStyle = fill; g.fill(); }
    if (stroke) { g.strokeStyle = stroke; g.lineWidth = width || 1; g.stroke(); }
  }

  function bar(g, x1, y1, x2, y2, half) {
    const length = Math.hypot(x2 - x1, y2 - y1) || 1, nx = -half * (y2 - y1) / length, ny = half * (x2 - x1) / length;
    g.beginPath();
    g.moveTo(x1 + nx, y1 + ny); g.lineTo(x2 + 0.7 * nx, y2 + 0.7 * ny);
    g.lineTo(x2 - 0.7 * nx, y2 - 0.7 * ny); g.lineTo(x1 - nx, y1 - ny);
    g.closePath();
    g.fillStyle = COLOUR.steel; g.fill();
    g.strokeStyle = COLOUR.ink; g.lineWidth = 1; g.stroke();
  }

  // An elastic rod: a bar along the deflection curve, magnified `bend` times. Points are (x up, y right).
  function bentBar(g, X, Y, from, to, half, bend) {
    const steps = 40, ux = to[0] - from[0], uy = to[1] - from[1], length = Math.hypot(ux, uy) || 1, left = [], right = [];
    for (let i = 0; i <= steps; i++) {
      const s = i / steps, thick = half * (1 - 0.3 * s);
      let w = 0;
      for (let k = 1; k <= scene.modes; k++) w += at(`rod_mode_${k}`) * Math.sin(k * Math.PI * s);
      for (const [side, sign] of [[left, 1], [right, -1]]) {
        const across = (bend * w + sign * thick) / length;
        side.push([from[0] + s * ux - across * uy, from[1] + s * uy + across * ux]);
      }
    }
    g.beginPath();
    for (const [x, y] of [...left, ...right.reverse()]) g.lineTo(X(y), Y(x));
    g.closePath();
    g.fillStyle = COLOUR.steel; g.fill();
    g.strokeStyle = COLOUR.ink; g.lineWidth = 1; g.stroke();
  }

  // Magnification of an elastic rod's deflection: the largest deflection is drawn as a tenth of the length.
  const bending = scene.modes && scene.peak.rod_deflection > 0 ? 0.1 * scene.rod / scene.peak.rod_deflection : 0;

  function arrow(g, x, y, dx, dy, colour) {
    const length = Math.hypot(dx, dy);
    if (length < 2) return;
    const ux = dx / length, uy = dy / length, head = Math.min(9, 0.6 * length);
    g.strokeStyle = g.fillStyle = colour;
    g.lineWidth = 2.5;
    g.beginPath(); g.moveTo(x, y); g.lineTo(x + dx - ux * head, y + dy - uy * head); g.stroke();
    g.beginPath(); g.moveTo(x + dx, y + dy);
    g.lineTo(x + dx - head * ux + 0.5 * head * uy, y + dy - head * uy - 0.5 * head * ux);
    g.lineTo(x + dx - head * ux - 0.5 * head * uy, y + dy - head * uy + 0.5 * head * ux);
    g.closePath(); g.fill();
  }

  // ---- magnification of the clearance, from 1 to 45 % of the bearing's radius; that of the bore to 20 % of the piston's
  const pinClearance = Math.max(scene.clearance, smallEnd ? smallEnd.clearance : 0);
  const largest = pinClearance ? 0.45 * scene.bearing / pinClearance : 1;
  const magnified = (most) => Math.pow(most, Number(byId("magnification").value));
  const magnification = () => magnified(largest);
  const atCrankPin = () => magnified(0.2 * scene.bearing / crankPin.clearance);   // at most 20 % of the piston pin's bearing
  const inBore = (radius) => magnified(0.2 * radius / bore.clearance);   // of a piston drawn with this radius [m]

  // x is up, y to the right
  function drawMechanism() {
    const { g, width, height } = prepare("mechanism");
    const { crank, rod, bearing } = scene, half = 2.4 * bearing;
    const top = crank + rod + 4.2 * bearing, bottom = -1.35 * crank;
    const scale = Math.min(height / (top - bottom), width / (2.9 * crank));
    const X = (y) => width / 2 + scale * y, Y = (x) => height - scale * (x - bottom);
    const B = (y) => X(scene.axis + y);   // from the axis of the bore
    const q = at("crank_angle"), piston = at("piston_position"), m = magnification();
    const px = crank * Math.cos(q), py = crank * Math.sin(q);
    // for a piston with clearance in its bore: the drawn distances of its axis and its pin from the cylinder axis, and its tilt
    const n = bore ? inBore(half) : 0, gap = bore ? n * bore.clearance : 0.05 * half;
    const aside = bore ? n * at("piston_offset") : 0, tilt = bore ? drawnTilt(n) : 0, pin = bore ? aside - bore.along * tilt - bore.across : 0;
    // for a crank pin with clearance: the big end's centre is drawn at the magnified eccentricity from the pin's centre
    const mc = crankPin ? atCrankPin() : 0;
    const bx = px - (crankPin ? mc * at("crank_pin_eccentricity_x") : 0), by = py - (crankPin ? mc * at("crank_pin_eccentricity_y") : 0);
    const ex = joint ? m * at("eccentricity_x") : 0, ey = (joint ? m * at("eccentricity_y") : 0) + pin;
    // for a pin with clearance in the small end: the centre of the rod's eye is drawn at the magnified eccentricity from the pin's
    const rx = ex - (smallEnd ? m * at("small_end_eccentricity_x") : 0), ry = ey - (smallEnd ? m * at("small_end_eccentricity_y") : 0);
    g.strokeStyle = COLOUR.ink; g.lineWidth = 2.5;
    for (const side of [-1, 1]) {
      g.beginPath();
      g.moveTo(B(side * (half + gap)), Y(Math.min(1.45 * crank, rod - crank))); g.lineTo(B(side * (half + gap)), Y(top));
      g.stroke();
    }
    if (column.cylinder_pressure) {
      const share = Math.min(1, at("cylinder_pressure") / scene.peak.cylinder_pressure);
      g.fillStyle = `rgba(213,94,0,${(0.75 * share).toFixed(3)})`;
      g.fillRect(B(-half), Y(top), 2 * half * scale, Y(piston + 2.6 * bearing) - Y(top));
    }
    circle(g, X(0), Y(0), 1.25 * crank * scale, COLOUR.light, COLOUR.grey, 1);
    bar(g, X(0), Y(0), X(py), Y(px), 0.9 * bearing * scale);
    g.fillStyle = COLOUR.light; g.strokeStyle = COLOUR.ink; g.lineWidth = 1.5;
    g.save();
    g.translate(B(aside), Y(piston)); g.rotate(tilt);   // x is up: from x to y is clockwise here
    g.beginPath(); g.rect(-half * scale, -2.6 * bearing * scale, 2 * half * scale, 4.1 * bearing * scale); g.fill(); g.stroke();
    g.restore();
    circle(g, B(pin), Y(piston), bearing * scale, COLOUR.paper, COLOUR.ink, 1.2);
    if (bending) bentBar(g, X, Y, [bx, by], [piston + rx, scene.axis + ry], 0.55 * bearing, bending);
    else bar(g, X(by), Y(bx), B(ry), Y(piston + rx), 0.55 * bearing * scale);
    const radius = bearing - m * pinClearance;   // of the pin
    if (smallEnd) circle(g, B(ry), Y(piston + rx), (radius + m * smallEnd.clearance) * scale, COLOUR.paper, COLOUR.ink, 1);
    circle(g, B(ey), Y(piston + ex), radius * scale * (joint || smallEnd ? 1 : 0.75), COLOUR.blue, COLOUR.ink, 1);
    if (column.pin_angle) {   // a mark on the pin shows how it turns
      const turn = at("pin_angle");
      g.beginPath(); g.moveTo(B(ey), Y(piston + ex)); g.lineTo(B(ey + radius * Math.sin(turn)), Y(piston + ex + radius * Math.cos(turn)));
      g.strokeStyle = COLOUR.paper; g.lineWidth = 2; g.stroke();
    }
    circle(g, X(0), Y(0), 0.45 * bearing * scale, COLOUR.paper, COLOUR.ink, 1);
    if (crankPin) circle(g, X(by), Y(bx), (0.45 * bearing + mc * crankPin.clearance) * scale, COLOUR.paper, COLOUR.ink, 1);
    circle(g, X(py), Y(px), 0.45 * bearing * scale, crankPin ? COLOUR.blue : COLOUR.paper, COLOUR.ink, 1);
  }

  // Lengths of arrows and heights of the pressure are proportional to the square root, so that small values are visible.
  const rooted = (value, peak, length) => (peak > 0 ? length * Math.sqrt(Math.min(1, Math.abs(value) / peak)) : 0);

  function drawJoint() {
    const { g, width, height } = prepare("joint");
    const cx = width / 2, cy = height / 2, room = Math.min(width, height) / 2, radius = 0.62 * room, m = magnification();
    const gap = m * scene.clearance / scene.bearing * radius;
    const ux = at("eccentricity_x") / scene.clearance, uy = at("eccentricity_y") / scene.clearance;
    const pinX = cx + gap * uy, pinY = cy - gap * ux;
    if (pressure) {
      const first = nearest() * scene.angles, direction = Math.atan2(uy, ux);
      for (const sign of [1, -1]) {
        g.beginPath();
        for (let i = 0; i <= scene.angles; i++) {
          const level = Math.max(0, sign * pressure[first + (i % scene.angles)]) / 127;
          const angle = direction + 2 * Math.PI * i / scene.angles - Math.PI, r = radius + 3 + 0.34 * room * level;
          g.lineTo(cx + r * Math.sin(angle), cy - r * Math.cos(angle));
        }
        g.arc(cx, cy, radius + 3, 0, 2 * Math.PI, true);
        g.fillStyle = sign > 0 ? COLOUR.green : COLOUR.sky;
        g.globalAlpha = 0.75; g.fill(); g.globalAlpha = 1;
      }
    }
    circle(g, cx, cy, radius, COLOUR.paper, COLOUR.ink, 2);
    if (oil) {   // where the gap is full the ring is dark, where the film has ruptured it is pale
      const first = nearest() * scene.angles, direction = Math.atan2(uy, ux), step = 2 * Math.PI / scene.angles;
      g.lineWidth = 5; g.strokeStyle = COLOUR.sky;
      for (let i = 0; i < scene.angles; i++) {
        const angle = direction + i * step - 1.5 * Math.PI;
        g.globalAlpha = Math.max(0, oil[first + i]) / 127;
        g.beginPath(); g.arc(cx, cy, radius - 4, angle - step / 2, angle + step / 2); g.stroke();
      }
      g.globalAlpha = 1;
    }
    for (const { angle, half } of scene.supply) {
      g.beginPath(); g.arc(cx, cy, radius + 5, angle - half - Math.PI / 2, angle + half - Math.PI / 2);
      g.lineWidth = 9; g.strokeStyle = COLOUR.sky; g.stroke();
    }
    circle(g, pinX, pinY, radius - gap, COLOUR.steel, COLOUR.ink, 1.2);
    circle(g, cx, cy, radius, null, COLOUR.ink, 2);
    const turn = column.pin_angle ? Math.PI + at("pin_angle") : -at("rod_angle"), mark = radius - gap;   // a line on the pin shows how it turns
    g.beginPath(); g.moveTo(pinX, pinY); g.lineTo(pinX - mark * Math.sin(turn), pinY + mark * Math.cos(turn));
    g.strokeStyle = COLOUR.grey; g.lineWidth = 1; g.stroke();
    circle(g, pinX, pinY, 2.5, COLOUR.ink);
    const fx = near("pin_force_x"), fy = near("pin_force_y"), force = Math.hypot(fx, fy);
    if (force > 0) {
      const length = rooted(force, scene.peak.pin_force, 0.55 * room);
      arrow(g, pinX, pinY, length * fy / force, -length * fx / force, COLOUR.blue);
    }
    if (column.normal_force && near("normal_force") > 0) {
      const e = Math.hypot(ux, uy) || 1, length = rooted(near("normal_force"), scene.peak.normal_force, 0.36 * room);
      const wx = cx + radius * uy / e, wy = cy - radius * ux / e;
      circle(g, wx, wy, 5, COLOUR.purple);
      arrow(g, wx + length * uy / e, wy - length * ux / e, -length * uy / e, length * ux / e, COLOUR.purple);
    }
  }

  // The tilt is magnified as much as the gaps, up to a limit.
  const drawnTilt = (n) => Math.max(-0.6, Math.min(0.6, n * at("piston_tilt")));

  function drawBore() {
    const { g, width, height } = prepare("bore");
    const n = inBore(bore.radius), tall = bore.top + bore.bottom;
    const scale = Math.min(0.8 * height / tall, 0.36 * width / (bore.radius + n * bore.clearance)), wall = scale * (bore.radius + n * bore.clearance);
    const cx = width / 2, cy = height / 2, sine = n * at("piston_tilt");   // all gaps are magnified n times
    const Y = (h) => cy - scale * (h - (bore.top - bore.bottom) / 2);
    const X = (h, side) => cx + scale * (side * bore.radius + n * at("piston_offset") + (h - bore.along) * sine);
    g.strokeStyle = COLOUR.ink; g.lineWidth = 2.5;
    for (const side of [-1, 1]) { g.beginPath(); g.moveTo(cx + side * wall, 4); g.lineTo(cx + side * wall, height - 4); g.stroke(); }
    g.beginPath();
    g.moveTo(X(bore.top, -1), Y(bore.top)); g.lineTo(X(bore.top, 1), Y(bore.top));
    g.lineTo(X(-bore.bottom, 1), Y(-bore.bottom)); g.lineTo(X(-bore.bottom, -1), Y(-bore.bottom));
    g.closePath();
    g.fillStyle = COLOUR.steel; g.fill(); g.strokeStyle = COLOUR.ink; g.lineWidth = 1.2; g.stroke();
    circle(g, X(0, 0) - scale * bore.across, Y(0), 0.25 * scale * bore.radius, COLOUR.paper, COLOUR.ink, 1.2);
    [[bore.top, 1], [-bore.bottom, 1], [bore.top, -1], [-bore.bottom, -1]].forEach(([h, side], i) => {
      const force = column.guide_1_force ? near(`guide_${i + 1}_force`) : 0;   // a film has no corners
      if (!(force > 0)) return;
      const length = rooted(force, scene.peak.guide_force, 0.4 * scale * bore.radius + 12), x = cx + side * wall;
      circle(g, x, Y(h), 5, COLOUR.purple);
      arrow(g, x + side * length, Y(h), -side * length, 0, COLOUR.purple);
    });
  }

  // The orbit of a pin's centre in its clearance circle. `of` is the prefix of the joint's columns, `most` the largest eccentricity
  // over the clearance.
  function drawOrbit(id, of, clearance, most) {
    const { g, width, height } = prepare(id);
    const cx = width / 2, cy = height / 2, unit = 0.46 * Math.min(width, height) / Math.max(1, most);
    const ex = `${of}eccentricity_x`, ey = `${of}eccentricity_y`, phase = column[`${of}phase`];
    const x = (i) => cx + unit * column[ey][i] / clearance;
    const y = (i) => cy - unit * column[ex][i] / clearance;
    const touching = (i) => phase && phase[i] === 2;
    const line = (from, to, strength, thick) => {   // parts in contact have another colour
      g.lineWidth = thick;
      g.globalAlpha = strength;
      for (let i = from; i < to;) {
        const inside = touching(i) || touching(i + 1);
        g.beginPath();
        g.moveTo(x(i), y(i));
        while (i < to && (touching(i) || touching(i + 1)) === inside) { i++; g.lineTo(x(i), y(i)); }
        g.strokeStyle = inside ? COLOUR.purple : COLOUR.blue;
        g.stroke();
      }
      g.globalAlpha = 1;
    };
    circle(g, cx, cy, unit, COLOUR.paper, null);
    for (const other of others || []) {
      const there = of ? other.scene[of.slice(0, -1)] : other.scene, [up, across] = [ex, ey].map((name) => other.column[name]);
      if (!there || !up) continue;
      g.beginPath();
      up.forEach((v, i) => g.lineTo(cx + unit * across[i] / there.clearance, cy - unit * v / there.clearance));
      g.strokeStyle = COLOUR[other.colour]; g.lineWidth = 1; g.stroke();
    }
    line(0, others ? scene.rows - 1 : row, 0.3, 1);
    let from = row;
    while (from > 0 && column.crank_angle[row] - column.crank_angle[from] < 2 * Math.PI) from--;
    line(from, row, 1, 1.4);
    circle(g, cx, cy, unit, null, COLOUR.ink, 1.5);
    circle(g, cx + unit * at(ey) / clearance, cy - unit * at(ex) / clearance, 5,
      touching(nearest()) ? COLOUR.purple : COLOUR.vermilion, COLOUR.paper, 1);
  }

  // ---- the time line: film thickness, or the pin's force, over the whole run, with the contacts below
  // Twist of a station [rad]; 0 of the full cylinder's, and on a rigid shaft.
  const twistOf = (station) => (scene.engine.twists[station] ? at(scene.engine.twists[station]) : 0);

  // All cylinders side by side along the shaft, each in its own plane seen from the side, and below them the twist of the shaft: the
  // largest is drawn as the height of its band.
  function drawEngine() {
    const { g, width, height } = prepare("engine");
    const { cylinders, full, twists, largest } = scene.engine, { crank, rod } = scene;
    const places = Math.max(cylinders.length, twists.length), band = twists.length ? 0.24 * height : 0;
    const scale = (height - band) / (2.6 * crank + rod + 1.2 * crank), base = height - band - 1.3 * crank * scale;
    const half = Math.min(0.32 * width / places, 0.6 * crank * scale);
    const X = (station, i) => width * ((twists.length ? station : i) + 0.5) / places;
    g.strokeStyle = COLOUR.grey; g.lineWidth = 2;
    g.beginPath(); g.moveTo(0.02 * width, base); g.lineTo(0.98 * width, base); g.stroke();
    cylinders.forEach(([station, angle], i) => {
      const theta = at("crank_angle") + angle + twistOf(station), x = X(station, i);
      const pin = base - scale * crank * Math.cos(theta);
      const piston = base - scale * (crank * Math.cos(theta) + Math.sqrt(rod * rod - (crank * Math.sin(theta)) ** 2));
      bar(g, x, pin, x, piston, 0.16 * half);
      g.fillStyle = i === full ? COLOUR.blue : COLOUR.light; g.strokeStyle = COLOUR.ink; g.lineWidth = 1.2;
      g.beginPath(); g.rect(x - half, piston - 0.45 * crank * scale, 2 * half, 0.8 * crank * scale); g.fill(); g.stroke();
      g.beginPath(); g.rect(x - 0.7 * half, Math.min(pin, base), 1.4 * half, Math.abs(pin - base)); g.fillStyle = COLOUR.steel; g.fill(); g.stroke();
      circle(g, x, pin, 0.22 * half, COLOUR.paper, COLOUR.ink, 1);
    });
    if (!(largest > 0)) return;
    const Y = (twist) => height - 0.5 * band - 0.45 * band * twist / largest;
    g.strokeStyle = COLOUR.grey; g.lineWidth = 0.7;
    g.beginPath(); g.moveTo(0, Y(0)); g.lineTo(width, Y(0)); g.stroke();
    g.strokeStyle = COLOUR.vermilion; g.lineWidth = 2;
    g.beginPath();
    twists.forEach((_, station) => g.lineTo(X(station, 0), Y(twistOf(station))));
    g.stroke();
    twists.forEach((_, station) => circle(g, X(station, 0), Y(twistOf(station)), 4, COLOUR.vermilion, COLOUR.ink, 1));
  }

  function drawTimeline() {
    const { g, width, height } = prepare("timeline");
    const curve = scene.line, values = column[curve.column], strip = scene.contacts.length ? 26 : 0, [low, high] = curve.range;
    const X = (t) => 8 + (width - 16) * (t - begin) / (end - begin);   // the title is above the curve
    const Y = (v) => 22 + (height - strip - 30) * (high - v) / (high - low || 1);
    if (joint && low < 0) { g.fillStyle = "rgba(204,121,167,0.18)"; g.fillRect(8, Y(0), width - 16, Y(low) - Y(0)); }
    if (joint) {
      g.beginPath(); g.moveTo(8, Y(0)); g.lineTo(width - 8, Y(0));
      g.strokeStyle = COLOUR.grey; g.lineWidth = 1; g.stroke();
    }
    g.beginPath();
    for (let i = 0; i < scene.rows; i++) g.lineTo(X(time[i]), Y(values[i]));
    g.strokeStyle = COLOUR.blue; g.lineWidth = 1; g.stroke();
    for (const contact of scene.contacts) {
      const tall = 4 + rooted(contact.force, scene.peak.normal_force, strip - 8);
      g.fillStyle = COLOUR.purple;
      g.globalAlpha = now >= contact.begin && now <= contact.end ? 1 : 0.55;
      g.fillRect(X(contact.begin), height - 3 - tall, Math.max(1.5, X(contact.end) - X(contact.begin)), tall);
    }
    g.globalAlpha = 1;
    g.font = "11px system-ui, sans-serif";
    const [least, most] = curve.extremes.map((value) => amount(value, curve.unit));
    g.fillStyle = COLOUR.muted;
    const text = local(withMinus(`${curve.title} ${least} … ${most}`));
    g.fillText(text, 10, 14);
    if (strip) {
      const x = 22 + g.measureText(text).width;
      g.fillText(W("contacts"), x + 12, 14);
      g.fillStyle = COLOUR.purple; g.fillRect(x, 6, 8, 8);
    }
    g.beginPath(); g.moveTo(X(now), 2); g.lineTo(X(now), height - 2);
    g.strokeStyle = COLOUR.vermilion; g.lineWidth = 2; g.stroke();
  }

  function drawState() {
    const degrees = at("crank_angle") * 180 / Math.PI, turn = scene.cycle && scene.cycle.degrees;
    const parts = [`t = ${(1e3 * now).toFixed(3)} ms`, `${W("crank")} ${(degrees - (turn ? turn * Math.floor(degrees / turn) : 0)).toFixed(1)}° (${(degrees / 360).toFixed(2)} ${W("rev")})`,
      `${(at("crank_speed") * 30 / Math.PI).toFixed(0)} rpm`, `${W("pin force")} ${amount(Math.hypot(near("pin_force_x"), near("pin_force_y")), "N")}`];
    if (joint) {
      const force = column.normal_force ? near("normal_force") : 0;
      parts.push(`${W("film")} ${amount(at("film_thickness"), "m")}`, ([W("free"), W("film acts"), W("contact")][near("phase")] || "")
        + (force > 0 ? `, ${amount(force, "N")}` : ""));
      if (pressure && near("phase") === 1) parts.push(`${W("film pressure up to")} ${amount(near("film_peak"), "Pa")}`);
    }
    if (column.pin_angle) parts.push(`${W("pin turned")} ${(at("pin_angle") * 180 / Math.PI).toFixed(2)}°`);
    if (bore) {
      const touching = column.guide_1_force ? [1, 2, 3, 4].filter((i) => near(`guide_${i}_force`) > 0) : [];
      parts.push(`${W("piston offset")} ${(1e6 * at("piston_offset")).toFixed(1)} µm, ${W("tilt")} ${(1e3 * at("piston_tilt")).toFixed(2)} mrad`
        + (touching.length ? `, ${W("corners on the bore:")} ${touching.join(", ")}` : ""));
    }
    if (bending) {
      let w = 0;
      for (let k = 1; k <= scene.modes; k += 2) w += at(`rod_mode_${k}`) * (k % 4 === 1 ? 1 : -1);
      parts.push(`${W("rod bent")} ${(1e6 * w).toFixed(1)} µm ${W("half way")} (${W("drawn")} × ${bending.toPrecision(2)})`);
    }
    if (scene.engine && scene.engine.largest > 0) parts.push(`${W("front end twisted")} ${(1e3 * (twistOf(0) - twistOf(scene.engine.twists.length - 1))).toFixed(2)} mrad`);
    const inside = scene.contacts.find((c) => now >= c.begin && now <= c.end);
    if (inside) {
      parts.push(`${W("this contact:")} ${amount(inside.end - inside.begin, "s")}, ${amount(inside.force, "N")}, ${amount(inside.penetration, "m")}`);
    }
    byId("state").replaceChildren(...parts.map((text) => Object.assign(document.createElement("span"), { textContent: local(withMinus(text)) })));
  }

  function draw() {
    drawMechanism();
    if (joint) { drawJoint(); drawOrbit("orbit", "", scene.clearance, scene.peak.eccentricity_ratio); }
    if (smallEnd) drawOrbit("small-end-orbit", "small_end_", smallEnd.clearance, smallEnd.peak_ratio);
    if (crankPin) drawOrbit("crank-pin-orbit", "crank_pin_", crankPin.clearance, crankPin.peak_ratio);
    if (mainBearing) drawOrbit("main-bearing-orbit", "main_bearing_", mainBearing.clearance, mainBearing.peak_ratio);
    if (bore) drawBore();
    if (scene.engine) drawEngine();
    drawTimeline();
    drawState();
    byId("scrub").value = (now - begin) / (end - begin);
    moved();
  }

  const shownMagnification = () => (pinClearance || !(bore || crankPin) ? magnification() : crankPin ? atCrankPin() : inBore(bore.radius));
  // The time of the next row, or of the one before.
  const neighbour = (forward) => time[Math.min(scene.rows - 1, Math.max(0, row + (forward ? 1 : share > 0 ? 0 : -1)))];
  // The time at which the next contact begins, or the one before; null without one.
  const contact = (forward) => {
    const found = forward ? scene.contacts.find((c) => c.begin > now + 1e-9) : scene.contacts.filter((c) => c.begin < now - 2e-9).pop();
    return found ? found.begin + 1e-9 : null;
  };
  const between = (xs, ys, x) => {
    let i = xs.findIndex((other) => other >= x);
    if (i < 0) i = scene.rows - 1;
    const from = Math.max(i - 1, 0), part = i > from ? (x - xs[from]) / (xs[i] - xs[from]) : 0;
    return ys[from] + part * (ys[i] - ys[from]);
  };
  const angleAt = (t) => between(time, column.crank_angle, t);   // the crank angle at a time [rad]
  const timeAt = (angle) => between(column.crank_angle, time, angle);
  return { scene, column, begin, end, seek, draw, at, magnification: shownMagnification, neighbour, contact, angleAt, timeAt, get now() { return now; } };
}

// Buttons, sliders and keys that move the drawing which `current()` returns. `stopped` is called when it stands still again.
function connectControls(current, stopped) {
  let playing = false, before = null;
  const turns = () => Math.pow(10, Number(byId("speed").value));   // revolutions a second
  const labels = () => {
    byId("speed-value").textContent = local(`${turns().toPrecision(2)} ${W("rev/s")}`);
    byId("magnification-value").textContent = local(`× ${current().magnification().toPrecision(3)}`);
  };

  function frame(stamp) {
    if (!playing) return;
    const drawing = current();
    if (before !== null) {
      const speed = Math.abs(drawing.at("crank_speed")) || drawing.scene.speed;
      const t = drawing.now + Math.min(0.1, (stamp - before) / 1e3) * turns() * 2 * Math.PI / speed;
      drawing.seek(t >= drawing.end ? drawing.begin : t);
    }
    before = stamp;
    requestAnimationFrame(frame);
  }

  function play(on) {
    playing = on;
    before = null;
    byId("play").textContent = on ? W("pause") : W("play");
    if (on) requestAnimationFrame(frame); else stopped();
  }
  const stopAt = (t) => { if (t !== null) { play(false); current().seek(t); } };
  const within = (part) => current().begin + part * (current().end - current().begin);

  byId("play").addEventListener("click", () => play(!playing));
  byId("scrub").addEventListener("input", (event) => stopAt(within(Number(event.target.value))));
  byId("speed").addEventListener("input", labels);
  byId("magnification").addEventListener("input", () => { labels(); current().draw(); });
  byId("next").addEventListener("click", () => stopAt(current().contact(true)));
  byId("previous").addEventListener("click", () => stopAt(current().contact(false)));
  const line = byId("timeline");
  const point = (event) => {
    const box = line.getBoundingClientRect();
    stopAt(within((event.clientX - box.left - 8) / (box.width - 16)));
  };
  line.addEventListener("pointerdown", (event) => { line.setPointerCapture(event.pointerId); point(event); });
  line.addEventListener("pointermove", (event) => { if (event.buttons) point(event); });
  document.addEventListener("keydown", (event) => {
    if (["INPUT", "BUTTON", "SELECT"].includes(event.target.tagName)) return;
    if (event.key === " ") { event.preventDefault(); play(!playing); }
    if (event.key === "ArrowRight" || event.key === "ArrowLeft") {
      event.preventDefault();
      stopAt(current().neighbour(event.key === "ArrowRight"));
    }
  });
  window.addEventListener("resize", () => current().draw());
  return { play, labels, get playing() { return playing; } };
}
