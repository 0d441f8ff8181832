// The explorer: sliders that run the case. Tests use the object `explorer`.
(function () {
  const settings = JSON.parse(byId("settings").textContent), page = Math.random().toString(36).slice(2);
  const MOST_KEPT = 4, RESTS = 350, GIVE_UP = 1000, SAYS = 300;   // ms: of a hand at rest, of a run that a newer one ends, before the clock is shown
  const values = {}, sliders = {};   // values that differ from the case; controls by key
  let shown = null, drawing = null, controls = null, kept = [], refused = false, swept = null;   // swept: the slider that was moved last
  Object.assign(spoken, settings);
  readColours();
  const element = (tag, more = {}, ...inside) => { const made = Object.assign(document.createElement(tag), more); made.append(...inside); return made; };
  const fail = (text) => { byId("failure").hidden = !text; byId("failure").textContent = text; };

  // ---- questions to the program: the head of its answer, and bytes by name
  async function ask(path, more = {}) {
    const answer = await fetch(path, { method: "POST", headers: { "X-Token": settings.token }, body: JSON.stringify({ page, values, ...more }) });
    if (!answer.ok) throw new Error(answer.status);
    const bytes = await answer.arrayBuffer(), length = bytes.byteLength ? new DataView(bytes).getUint32(0, true) : 0;
    const head = length ? JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length))) : {}, data = {};
    let from = 4 + length;
    for (const [name, size] of Object.entries(head.sizes || {})) { data[name] = [bytes, from, size]; from += size; }
    return { head, data };
  }
  const asked = (...question) => ask(...question).catch(() => { fail(W("gudgeon-plot explore has ended; start it again.")); return null; });

  // ---- one run at a time, always with the newest values; a slow one is given up. When the hand rests, the run in full.
  let request = 0, flying = null, waiting = null, rest = null, ticking = null;
  async function go(tier) {
    clearTimeout(rest); clearTimeout(waiting);
    if (refused) { fail(shown && shown.head.failed); mark(); refused = false; }   // that value is gone
    const mine = ++request, began = performance.now();
    flying = { tier, began }; waiting = null;
    clearInterval(ticking);
    ticking = setInterval(() => {
      const past = performance.now() - began;
      byId("busy").hidden = past < SAYS;
      byId("clock").textContent = local(`${W(tier === "live" ? "computing" : "computing in full")} ${(past / 1e3).toFixed(1)} s`);
    }, 100);
    const answer = await asked("/run", { request: mine, tier });
    if (mine !== request) return;
    landed();
    if (!answer || answer.head.superseded) return;
    if (answer.head.error) wrong(answer.head); else show(answer);
    explorer.runs.push({ tier, ms: performance.now() - began });
    if (waiting) go("live");
    else if (!answer.head.error) rest = setTimeout(() => { remember(); if (answer.head.draft) go("full"); }, RESTS);
  }
  function landed() { flying = null; clearInterval(ticking); byId("busy").hidden = true; }
  function changed() {
    clearTimeout(rest);
    if (!flying || flying.tier !== "live") go("live");
    else if (!waiting) waiting = setTimeout(() => go("live"), Math.max(0, flying.began + GIVE_UP - performance.now()));
  }
  byId("stop").addEventListener("click", () => { clearTimeout(waiting); request++; landed(); asked("/stop", { request }); });
  byId("certify").addEventListener("click", () => go("certify"));

  const mark = (key) => { for (const [name, slider] of Object.entries(sliders)) slider.div.classList.toggle("wrong", name === key); };
  function wrong(head) {   // the last picture stays
    fail(head.error);
    mark(head.key);
    refused = true;
  }

  function show({ head, data }) {
    const { scene } = head, column = {}, bytes = (name) => (data[name][2] ? new Int8Array(...data[name]) : null);
    const all = new Float32Array(data.trace[0], data.trace[1], data.trace[2] / 4);
    scene.columns.forEach((name, i) => { column[name] = all.subarray(i * scene.rows, (i + 1) * scene.rows); });
    for (const [name, value] of Object.entries(head.values)) if (name in values && typeof values[name] === "string" && values[name] !== value) { values[name] = value; sliders[name].put(value); }
    shown = { head, scene, column, pressure: bytes("pressure"), oil: bytes("oil"), values: { ...values } };
    fail(head.failed);
    mark();
    redraw();
    controls = controls || connectControls(() => drawing, () => {});
    controls.labels();
  }
  function redraw() {   // at the same crank angle as before
    const { scene } = shown, angle = drawing ? abscissa(drawing, drawing.at("crank_angle")) : null;
    drawing = drawingOf(scene, shown.column, shown.pressure, shown.oil, markCharts, kept.map((run, i) => ({ ...run, colour: GHOSTS[i] })));
    tell();
    charts();
    drawing.seek(angle === null ? scene.start : drawing.timeAt(atAbscissa(drawing, angle)));
  }

  // ---- answers of this run and of those that are kept
  const GHOSTS = ["vermilion", "green", "sky", "grey"];
  const valueOf = (run, name) => (sliders[name] ? sliders[name].text(name in run.values ? run.values[name] : sliders[name].about.start) : name in run.values ? String(run.values[name]) : W("as given"));
  const named = (run) => Object.keys(run.values).map((name) => `${name} = ${valueOf(run, name)}`).join(", ") || W("as given");
  function tell() {
    const runs = [shown, ...kept], of = runs.map((run) => Object.fromEntries(run.head.answers));
    const keys = [...new Set(runs.flatMap((run) => Object.keys(run.values)))].filter((name) => kept.some((run) => run.values[name] !== shown.values[name]));
    const heads = kept.map((run, i) => element("th", {}, element("i", { style: `background: ${COLOUR[GHOSTS[i]]}` }),
      element("button", { type: "button", textContent: W("back"), onclick: () => restore(run.values) }), " ",
      element("button", { type: "button", textContent: "×", ariaLabel: W("remove"), onclick: () => { kept = kept.filter((other) => other !== run); redraw(); } })));
    byId("answers").className = shown.head.draft || shown.head.failed ? "draft" : "";
    byId("top").classList.toggle("alone", !kept.length);
    byId("answers").replaceChildren(element("tr", {}, element("th"), element("th", { textContent: shown.head.draft ? W("draft") : W("now") }), ...heads),
      ...keys.map((name) => element("tr", { className: "key-row" }, element("td", { textContent: name }), ...runs.map((run) => element("td", { textContent: valueOf(run, name) })))),
      ...Object.keys(of[0]).map((name) => element("tr", {}, element("td", { textContent: name }), ...of.map((one) => element("td", { innerHTML: one[name] || "" })))));
    byId("notes").replaceChildren(...shown.head.notes.map((text) => element("p", { textContent: text })));
  }
  function keep() { if (shown) { kept = [shown, ...kept].slice(0, MOST_KEPT); redraw(); } }

  // ---- curves over the crank angle of the cycle, kept runs behind
  const abscissa = ({ scene }, radians) => (scene.cycle ? angleInCycle(scene.cycle, radians) : radians * 180 / Math.PI);
  const atAbscissa = ({ scene: { cycle } }, degrees) => Math.PI / 180 * (cycle ? (degrees - angleInCycle(cycle, cycle.angle) + cycle.degrees) % cycle.degrees : degrees) + (cycle ? cycle.angle : 0);
  // The curves of a run in a plot: those of several bearings have their own dashes, as the run has its colour.
  const DASHES = [[], [7, 3], [2, 2], [9, 2, 2, 2]], PLOTLY_DASHES = ["solid", "dash", "dot", "dashdot"];
  function seriesOf(run, title) {   // in the units of the axes, which are those of the run that is shown
    const [plot, axes] = [run, shown].map(({ scene }) => scene.plots.find((one) => one.title === title)), { x_factor, y_factor } = axes.curves[0];
    const times = (name, factor) => Array.from(run.column[name], (v) => v * factor);
    return (plot ? plot.curves : []).map((curve, k) => {
      const x = plot.timed ? Array.from(run.column.crank_angle, (v) => abscissa(run, v)) : times(curve.x, x_factor);
      const fold = plot.timed && run.scene.cycle ? foldOf(x, run.scene.cycle.degrees) : -1;
      return { name: curve.name, k, x: fromFold(x, fold), y: fromFold(times(curve.y, y_factor), fold) };
    });
  }
  function charts() {
    const { plots } = shown.scene, there = [...byId("charts").children].map((one) => one.dataset.title);
    if (there.join() !== plots.map((plot) => plot.title).join()) {
      byId("charts").replaceChildren(...plots.map((plot) => {
        const canvas = element("canvas", { role: "button", tabIndex: 0, ariaLabel: plot.title, onclick: () => zoom(plot.title), onkeydown: (event) => { if (event.key === "Enter") zoom(plot.title); } }), figure = element("figure", {}, canvas, element("i"));
        figure.dataset.title = plot.title;
        return figure;
      }));
    }
    plots.forEach((plot, i) => {
      const colours = [...GHOSTS.slice(0, kept.length).reverse(), "blue"];
      drawChart(byId("charts").children[i], plot, [...[...kept].reverse(), shown].flatMap((run, j) => seriesOf(run, plot.title).map((series) => [series, colours[j]])));
    });
  }
  function nice(low, high, parts) {   // round values between two
    const raw = (high - low) / parts, power = 10 ** Math.floor(Math.log10(raw)), step = [1, 2, 5, 10].find((m) => m * power >= raw) * power, found = [];
    for (let i = Math.ceil(low / step); i * step <= high; i++) found.push(Number((i * step).toPrecision(6)));
    return found;
  }
  function drawChart(figure, plot, list) {
    const canvas = figure.firstChild, ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight, g = canvas.getContext("2d");
    canvas.width = Math.round(width * ratio); canvas.height = Math.round(height * ratio); g.scale(ratio, ratio);
    const span = (axis) => {
      let low = Infinity, high = -Infinity;
      for (const [series] of list) for (const v of series[axis]) if (v !== null) { low = Math.min(low, v); high = Math.max(high, v); }
      return high > low ? [low, high] : [low - 1, high + 1];
    };
    const cycle = plot.timed && shown.scene.cycle, [x0, x1] = cycle ? axisOf(cycle) : span("x"), [y0, y1] = span("y");
    const X = (v) => 46 + (width - 60) * (v - x0) / (x1 - x0), top = plot.curves.length > 1 ? 40 : 22, Y = (v) => top + (height - top - 22) * (y1 - v) / (y1 - y0);
    g.font = "11px system-ui, sans-serif";
    if (plot.timed) {
      g.fillStyle = "rgba(127,127,127,0.25)";
      for (const [from, to] of partsBeyond(shown.scene.certified, drawing.begin, drawing.end, (t) => abscissa(shown, drawing.angleAt(t)), [x0, x1])) g.fillRect(X(from), top, X(to) - X(from), height - top - 22);
    }
    g.strokeStyle = COLOUR.line; g.lineWidth = 1; g.fillStyle = COLOUR.muted; g.textAlign = "right";
    for (const v of nice(y0, y1, 4)) { g.beginPath(); g.moveTo(46, Y(v)); g.lineTo(width - 14, Y(v)); g.stroke(); g.fillText(local(String(v)), 42, Y(v) + 4); }
    g.textAlign = "center";
    const step = cycle ? (cycle.degrees > 360 ? 180 : 90) : 0;
    for (const v of cycle ? Array.from({ length: cycle.degrees / step + 1 }, (_, i) => x0 + i * step) : nice(x0, x1, 5)) g.fillText(local(String(v).replace("-", "−")), X(v), height - 8);
    g.textAlign = "left"; g.fillStyle = COLOUR.ink;
    const title = plot.timed ? `${plot.title} [${plot.y}]` : `${plot.y}, ${plot.x}`;
    g.fillText(g.measureText(title).width > width - 8 ? title.replace(/ \([^)]*\)/, "") : title, 4, 13, width - 8);
    if (plot.curves.length > 1) {   // names of the bearings, from the right
      let right = width - 14;
      g.strokeStyle = COLOUR.ink; g.font = "10px system-ui, sans-serif";
      for (const [k, curve] of [...plot.curves.entries()].reverse()) {
        const wide = g.measureText(curve.name).width;
        g.fillText(curve.name, right - wide, 32);
        g.setLineDash(DASHES[k % 4]); g.beginPath(); g.moveTo(right - wide - 20, 28); g.lineTo(right - wide - 3, 28); g.stroke();
        right -= wide + 28;
      }
    }
    g.save(); g.beginPath(); g.rect(46, top - 2, width - 60, height - top - 18); g.clip();
    for (const [series, colour] of list) {
      g.setLineDash(DASHES[series.k % 4]);
      g.beginPath();
      series.x.forEach((v, i) => { if (v !== null) g[i && series.x[i - 1] !== null ? "lineTo" : "moveTo"](X(v), Y(series.y[i])); });
      g.strokeStyle = COLOUR[colour]; g.lineWidth = colour === "blue" ? 1.5 : 1; g.globalAlpha = colour === "blue" ? 1 : 0.7; g.stroke(); g.globalAlpha = 1;
    }
    g.restore();
    figure.place = plot.timed ? X : null;
  }
  function markCharts() {
    const x = abscissa(shown, drawing.at("crank_angle"));
    for (const figure of byId("charts").children) {
      const mark = figure.lastChild;
      mark.hidden = !figure.place;
      if (figure.place) mark.style.left = `${figure.place(x)}px`;
    }
  }
  async function zoom(title) {
    byId("zoom").showModal();
    if (!window.Plotly) {
      const script = element("script", { src: `/plotly.js?token=${settings.token}` });
      await new Promise((done) => { script.onload = done; document.head.append(script); });
    }
    const plot = shown.scene.plots.find((one) => one.title === title), colours = [...GHOSTS.slice(0, kept.length).reverse(), "blue"];
    const several = plot.curves.length > 1, data = [...[...kept].reverse(), shown].flatMap((run, i) => seriesOf(run, title).map(({ x, y, k, name }) => ({ x, y, type: "scatter", mode: "lines",
      name: [...(several ? [name] : []), ...(kept.length || !several ? [run === shown ? W("now") : named(run)] : [])].join(", "), line: { color: COLOUR[colours[i]], width: 1.2, dash: PLOTLY_DASHES[k % 4] } })));
    Plotly.newPlot("zoomed", data, { title: { text: plot.title }, paper_bgcolor: COLOUR.paper, plot_bgcolor: COLOUR.paper, font: { color: COLOUR.ink }, separators: spoken.comma ? ",." : ".,",
      xaxis: { title: { text: plot.timed ? W("crank angle [deg]") : plot.x } }, yaxis: { title: { text: plot.y } } }, { responsive: true, displaylogo: false });
  }

  // ---- sliders from what the program declares of keys
  function build(about) {
    const { name, factor, offset, unit, low, high } = about, label = element("label", { title: about.help }, element("span", { textContent: name.replace(/[._]/g, "$&\u200b") }));
    const help = element("small", { textContent: about.help, hidden: true });
    const div = element("div", { className: "slider" }, label, help);
    label.firstChild.append(element("button", { type: "button", textContent: "?", ariaLabel: `${name}?`, onclick: (event) => { event.preventDefault(); help.hidden = !help.hidden; } }));
    div.dataset.key = name;
    const mark = () => div.classList.toggle("changed", name in values);
    const set = (value) => { if (value === about.start) delete values[name]; else values[name] = value; mark(); changed(); };
    let put;
    const text = (value) => (about.words || typeof value !== "number" ? String(value) : local(`${+(value * factor + offset).toPrecision(4)} ${unit}`.trim()));
    if (about.words) {
      const box = element("select", { onchange: () => { set(about.kind === "switch" ? box.value === "true" : box.value); refresh(); } }, ...about.words.map((word) => new Option(word, word)));
      put = (value) => { box.value = String(value); };
      label.append(box);
    } else {
      const box = element("input", { type: "text" }), slider = element("input", { type: "range", min: 0, max: 200, step: 1, ariaLabel: name });
      const place = (value) => 200 * (about.log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low));
      const at = (share) => {   // four digits in the unit that is shown
        const value = about.log ? low * (high / low) ** share : low + (high - low) * share;
        return about.kind === "integer" ? Math.round(value) : (Number((value * factor + offset).toPrecision(4)) - offset) / factor;
      };
      put = (value) => { box.value = text(value); if (typeof value === "number") slider.value = place(value); };
      slider.addEventListener("input", () => { const value = at(slider.value / 200); box.value = text(value); swept = { name, at }; set(value); });
      swept = swept || { name, at };
      box.addEventListener("change", () => {
        const typed = box.value.trim().replace(/^([-+]?\d*),(\d*)(?![\d.,])/, "$1.$2"), found = typed.match(/^([-+]?[\d.]+(?:e[-+]?\d+)?)\s*(.*)$/i);
        const value = found && Number.isFinite(Number(found[1])) && (found[2] === "" || found[2] === unit) ? (Number(found[1]) - offset) / factor : typed;
        put(value);
        set(value);
      });
      label.append(box);
      div.append(slider);
    }
    div.addEventListener("dblclick", (event) => { if (event.target.type !== "text" && event.target.tagName !== "SELECT") { put(about.start); set(about.start); } });
    put(name in values ? values[name] : about.value);
    mark();
    sliders[name] = { div, put, text, about };
    return div;
  }
  function place(list) {
    const used = document.activeElement.closest(".slider");
    for (const name of Object.keys(sliders)) delete sliders[name];
    byId("sliders").replaceChildren(...list.map(build));
    if (used && sliders[used.dataset.key]) sliders[used.dataset.key].div.querySelector("select, [type=range]").focus();
  }
  async function refresh() {   // another law has other keys
    const answer = await asked("/controls");
    if (answer && answer.head.controls) place(answer.head.controls);
  }
  byId("more").addEventListener("focus", async () => {
    const answer = await asked("/keys");
    if (answer) byId("keys").replaceChildren(...answer.head.keys.map((name) => new Option(name)));
  }, { once: true });
  byId("more").addEventListener("change", async (event) => {
    const name = event.target.value.trim(), answer = await asked("/controls", { more: [name] });
    if (!answer) return;
    if (answer.head.error) { fail(answer.head.error); return; }
    event.target.value = "";
    place(answer.head.controls);
  });

  // ---- the values in the address, for back, forward and links
  const written = () => Object.entries(values).map(([name, value]) => `${name}=${encodeURIComponent(JSON.stringify(value))}`).join("&");
  function remember() { if (location.hash.slice(1) !== written()) history.pushState(null, "", `#${written()}`); }
  function restore(wanted) {
    for (const name of Object.keys(values)) delete values[name];
    Object.assign(values, wanted);
    refresh();
    changed();
  }
  function fromAddress() {
    const found = {};
    for (const part of location.hash.slice(1).split("&").filter(Boolean)) {
      const [name, value] = part.split("=");
      try { found[name] = JSON.parse(decodeURIComponent(value)); } catch { /* not written by this page */ }
    }
    restore(found);
  }
  window.addEventListener("popstate", fromAddress);

  // ---- what leaves the page
  function copy(text) { byId("copied").textContent = text; navigator.clipboard?.writeText(text).catch(() => {}); }
  const quoted = (value, yes, no) => (typeof value === "boolean" ? (value ? yes : no) : value);
  byId("copy-set").addEventListener("click", () => copy(["gudgeon", ...Object.entries(values).map(([name, value]) => `--set '${name}=${quoted(value, "T", "F")}'`), settings.words_of_case].join(" ")));
  const inPython = (without) => {
    const list = Object.entries(values).filter(([name]) => name !== without).map(([name, value]) => `"${name}": ${typeof value === "boolean" ? quoted(value, "True", "False") : JSON.stringify(value)}`).join(", ");
    return list ? `${settings.source}.set({${list}})` : settings.source;
  };
  byId("copy-python").addEventListener("click", () => copy(`${inPython()}.run()`));
  byId("copy-sweep").addEventListener("click", () => copy(`gudgeon.sweep(${inPython(swept.name)}, {"${swept.name}": [${Array.from({ length: 11 }, (_, i) => swept.at(i / 10)).join(", ")}]})`));
  function save(content, ending) {
    const link = element("a", { href: URL.createObjectURL(new Blob([content])), download: `${settings.name}${ending}` });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1e4);
  }
  for (const [id, path, ending] of [["save-case", "/case", ".nml"], ["save-csv", "/csv", ".csv"], ["save-page", "/report", ".html"]]) {
    byId(id).addEventListener("click", async () => {
      const answer = await asked(path);
      if (!answer) return;
      if (answer.head.error) fail(answer.head.error); else save(new Uint8Array(...answer.data.file), ending);
    });
  }

  // The right-hand side of the page as it is shown: its canvases, its colours, and its texts word by word.
  async function picture() {
    const main = document.querySelector("main"), area = main.getBoundingClientRect(), ratio = 2, outside = "#controls, #busy, [hidden], #answers button";
    const canvas = element("canvas", { width: ratio * main.clientWidth, height: ratio * main.scrollHeight }), g = canvas.getContext("2d");
    g.scale(ratio, ratio); g.fillStyle = COLOUR.paper; g.fillRect(0, 0, canvas.width, canvas.height);
    g.translate(-area.left, main.scrollTop - area.top);
    const drawn = [...main.querySelectorAll("*")].filter((one) => !one.closest(outside) && one.getClientRects().length);
    for (const one of drawn) {
      const box = one.getBoundingClientRect(), style = getComputedStyle(one), mark = getComputedStyle(one, "::before");
      g.fillStyle = style.backgroundColor; g.fillRect(box.left, box.top, box.width, box.height);
      if (one.matches(".key")) { g.fillStyle = mark.backgroundColor; g.fillRect(box.left, box.top + 3, parseFloat(mark.width), parseFloat(mark.height)); }
      if (one.tagName === "CANVAS") g.drawImage(one, box.left, box.top, box.width, box.height);
      g.fillStyle = style.color; g.font = `${style.fontWeight} ${style.fontSize} ${style.fontFamily}`; g.textBaseline = "middle";
      for (const text of [...one.childNodes].filter((node) => node.nodeType === Node.TEXT_NODE)) {
        for (const { 0: word, index } of text.data.matchAll(/\S+/g)) {
          const range = document.createRange();
          range.setStart(text, index); range.setEnd(text, index + word.length);
          const place = range.getBoundingClientRect();
          g.fillText(word, place.left, (place.top + place.bottom) / 2);
        }
      }
    }
    save(await new Promise((done) => { canvas.toBlob(done, "image/png"); }), ".png");
  }
  byId("save-picture").addEventListener("click", picture);
  byId("keep").addEventListener("click", keep);
  byId("reset").addEventListener("click", () => restore({}));
  document.addEventListener("keydown", (event) => { if (event.key === "k" && !(event.ctrlKey || event.metaKey || event.altKey) && !event.target.matches("[type=text], select, #more")) keep(); });
  const again = () => { if (shown) { readColours(); redraw(); } };
  window.addEventListener("resize", again);
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", again);
  window.explorer = { runs: [], values, get shown() { return shown; }, get drawing() { return drawing; }, get kept() { return kept; }, get busy() { return flying; } };
  place(settings.controls);
  if (location.hash) fromAddress(); else go("live");
})();
