"use strict";
// Unpacks the trace, moves the mechanism, draws the plots. Tests use the object `gudgeon`.
(async function () {
  readColours();
  const fail = (message) => { byId("failure").hidden = false; byId("failure").textContent = message; };
  if (!("DecompressionStream" in window)) { fail("This browser cannot unpack the page's data: it is older than 2023."); return; }

  async function unpack(id) {
    const bytes = Uint8Array.from(atob(byId(id).textContent), (c) => c.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Response(stream).arrayBuffer();
  }

  // ---- the trace: columns of float32, one after the other
  const scene = JSON.parse(byId("scene").textContent);
  Object.assign(spoken, { words: scene.words, comma: scene.comma });
  const column = {};
  {
    const values = new Float32Array(await unpack("trace"));
    scene.columns.forEach((name, i) => { column[name] = values.subarray(i * scene.rows, (i + 1) * scene.rows); });
  }
  const oil = document.getElementById("oil").textContent ? new Int8Array(await unpack("oil")) : null;
  const pressure = scene.angles ? new Int8Array(await unpack("pressure")) : null;

  const drawing = drawingOf(scene, column, pressure, oil), { seek, draw, end } = drawing, time = column.time;
  const controls = connectControls(() => drawing, () => markPlots());

  // ---- plots
  const charts = [];
  let linking = false, marked = null;

  // ---- the abscissa of the plots over time: time [ms] or crank angle [degrees], of all rows or of the last cycle
  const overAngle = () => byId("abscissa").value === "angle";
  const cycleAlone = () => Boolean(scene.cycle) && byId("last-cycle").checked;
  const shownRows = () => (cycleAlone() ? rowsOfCycle() : [0, scene.rows]);
  const rowsOfCycle = () => {
    const slack = 1e-4 * (scene.cycle.end - scene.cycle.begin);
    let first = time.findIndex((t) => t >= scene.cycle.begin - slack), last = scene.rows;
    while (last > first && time[last - 1] > scene.cycle.end + slack) last--;
    return [first, last];
  };
  const angleOf = (radians) => (cycleAlone() ? angleInCycle(scene.cycle, radians) : radians * 180 / Math.PI);   // or counted on over all revolutions
  const inCycle = () => overAngle() && cycleAlone();
  const abscissae = () => {
    const [first, last] = shownRows();
    return Array.from(overAngle() ? column.crank_angle.subarray(first, last) : time.subarray(first, last), (v) => (overAngle() ? angleOf(v) : 1e3 * v));
  };
  const fold = () => (inCycle() ? foldOf(abscissae(), scene.cycle.degrees) : -1);
  const abscissaAt = (t) => (overAngle() ? angleOf(drawing.angleAt(t)) : 1e3 * t);

  // Dead centres in the cycle shown, as thin lines, and ticks each quarter of a revolution.
  const deadCentres = () => {
    if (!inCycle()) return [];
    const first = [Math.asin(scene.axis / (scene.crank + scene.rod)), Math.PI + Math.asin(scene.axis / (scene.rod - scene.crank))];
    return first.flatMap((angle) => Array.from({ length: scene.cycle.degrees / 360 + 1 }, (_, turn) => 180 / Math.PI * angle + scene.cycle.from + 360 * turn))
      .filter((x) => x >= axisOf(scene.cycle)[0] && x <= axisOf(scene.cycle)[1])
      .map((x) => ({ type: "line", layer: "below", x0: x, x1: x, yref: "paper", y0: 0, y1: 1, line: { color: COLOUR.grey, width: 0.6, dash: "dot" } }));
  };
  const ticks = () => (inCycle() ? { "xaxis.range": axisOf(scene.cycle), "xaxis.tickmode": "linear", "xaxis.tick0": 0, "xaxis.dtick": 90 }
    : { "xaxis.autorange": true, "xaxis.tickmode": "auto" });

  // The part of the run beyond its certified time.
  const uncertified = () => {
    const [from, to] = cycleAlone() ? [scene.cycle.begin, scene.cycle.end] : [drawing.begin, end];
    return partsBeyond(scene.certified, from, to, abscissaAt, inCycle() ? axisOf(scene.cycle) : [abscissaAt(from), abscissaAt(to)]).map(([x0, x1]) => (
      { type: "rect", layer: "below", x0, x1, yref: "paper", y0: 0, y1: 1, fillcolor: "rgba(127,127,127,0.18)", line: { width: 0 } }));
  };

  function markPlots() {   // mark the moment shown on the time axes; not while playing, which would be too slow
    clearTimeout(marked);
    marked = setTimeout(() => {
      for (const chart of charts.filter((c) => c.timed)) {
        const x = abscissaAt(drawing.now);
        Plotly.relayout(chart.div, { shapes: [...uncertified(), ...deadCentres(), { type: "line", x0: x, x1: x, yref: "paper", y0: 0, y1: 1,
          line: { color: COLOUR.vermilion, width: 1 } }] });
      }
    }, 150);
  }

  async function changeAbscissa() {
    const at = fold(), x = fromFold(abscissae(), at), [first, last] = shownRows(), title = overAngle() ? W("crank angle [deg]") : W("time [ms]");
    linking = true;
    for (const chart of charts.filter((c) => c.timed)) {
      await Plotly.update(chart.div, { x: chart.curves.map(() => x), y: chart.curves.map((curve) => fromFold(values(curve, "y").slice(first, last), at)) },
        { "xaxis.title.text": title, "yaxis.autorange": true, ...ticks() });
    }
    linking = false;
    markPlots();
  }

  async function linkZoom(source, change) {
    if (linking) return;
    let update = null;
    if (change["xaxis.range[0]"] !== undefined) update = { "xaxis.range": [change["xaxis.range[0]"], change["xaxis.range[1]"]] };
    if (change["xaxis.autorange"]) update = { "xaxis.autorange": true };
    if (!update) return;
    linking = true;
    await Promise.all(charts.filter((c) => c.timed && c.div !== source).map((c) => Plotly.relayout(c.div, update)));
    linking = false;
  }

  function values(curve, axis) {
    const factor = curve[axis + "_factor"] || 1, source = column[curve[axis]];
    return Array.from(source, (v) => v * factor);
  }

  // Colours of the charts: of their frame, and of their curves, whose names of colours are their `meta`.
  const theme = () => ({ layout: { paper_bgcolor: COLOUR.paper, plot_bgcolor: COLOUR.paper, font: { color: COLOUR.ink }, shapedefaults: { line: { color: COLOUR.ink } },
    modebar: { color: COLOUR.grey, activecolor: COLOUR.ink, bgcolor: COLOUR.paper }, hoverlabel: { bgcolor: COLOUR.soft, font: { color: COLOUR.ink } },
    xaxis: { gridcolor: COLOUR.line, zerolinecolor: COLOUR.grey }, yaxis: { gridcolor: COLOUR.line, zerolinecolor: COLOUR.grey } } });
  // Title and margins of a chart `width` wide: a title has the size that fits beside the tool bar, which is not there on a phone and on
  // paper, where it begins at the edge of the chart; a legend has as many lines as its names need.
  const narrow = (onPaper = false) => onPaper || window.matchMedia("(max-width: 600px)").matches;
  const frameFor = (isNarrow, names, text, width) => {
    const size = Math.max(9, Math.min(isNarrow ? 12 : 14, Math.floor((width - (isNarrow ? 10 : 190)) / (0.58 * text.length)))), [l, r] = isNarrow ? [55, 12] : [70, 15];
    const inRow = Math.max(1, Math.floor((width - l - r) / ((isNarrow ? 5.6 : 6.5) * Math.max(...names.map((name) => name.length)) + 43))), rows = names.length > 1 ? Math.ceil(names.length / inRow) : 0;
    return { title: { font: { size }, xref: isNarrow ? "container" : "paper" }, margin: { l, r, t: rows ? 34 + 20 * rows : 40, b: 45 }, letters: isNarrow ? 10 : 11 };
  };
  const named = (data) => [...new Set(data.map(({ name }) => name))];   // what is in the legend, each once
  const framed = (c, onPaper) => {
    const { title, margin, letters } = frameFor(narrow(onPaper), named(c.div.data), c.div.layout.title.text, onPaper ? 340 : c.div.clientWidth);
    return { "title.font.size": title.font.size, "title.xref": title.xref, "legend.font.size": letters, margin };
  };
  function recolour(sizes = () => ({})) {
    readColours();
    draw();
    charts.forEach((c) => Plotly.update(c.div, { "line.color": c.div.data.map((curve) => COLOUR[curve.meta]) }, { template: theme(), ...sizes(c) }));
  }

  async function drawPlot(plot) {
    const div = document.createElement("div");
    if (plot.square) div.className = "square";
    document.querySelector(`${plot.main ? "" : "#more-plots "}.${plot.square ? "planes" : "plots"}`).append(div);
    const alone = plot.alone && scene.cycle, rows = alone ? rowsOfCycle() : [0, scene.rows];
    const title = alone ? `${plot.title}, ${W("last cycle")}` : plot.title;
    const phase = plot.phase ? column[plot.phase].subarray(...rows) : null;
    const data = plot.curves.flatMap((curve) => {
      const [x, y] = ["x", "y"].map((axis) => values(curve, axis).slice(...rows));
      const trace = (name, colour, keep) => ({ type: "scatter", mode: "lines", name, meta: colour, x, y: keep ? y.map((v, i) => (keep(i) ? v : null)) : y,
        line: { color: COLOUR[colour], width: curve.dash ? 1.2 : 1, dash: curve.dash || "solid" }, connectgaps: false });
      if (!phase || !phase.includes(2)) return [trace(curve.name, curve.colour)];
      const touching = (i) => phase[i] === 2 || phase[i - 1] === 2 || phase[i + 1] === 2;
      return [trace(W("apart"), curve.colour, (i) => phase[i] !== 2), trace(W("in contact"), "purple", touching)];
    });
    data.forEach((one, i) => { one.showlegend = data.findIndex(({ name }) => name === one.name) === i; });
    const shapes = plot.circle ? [{ type: "circle", x0: -1, x1: 1, y0: -1, y1: 1, line: { width: 1 } }] : plot.timed ? uncertified() : [];
    const frame = frameFor(narrow(), named(data), title, div.clientWidth || byId("plots").firstChild.clientWidth);
    await Plotly.newPlot(div, data, { template: theme(),
      title: { ...frame.title, text: title, x: 0, xanchor: "left", y: 1, yref: "container", yanchor: "top", pad: { t: 10 } },
      margin: frame.margin, shapes, font: { size: 11 }, separators: spoken.comma ? ",." : ".,", hovermode: plot.timed ? "x" : "closest",
      showlegend: data.length > 1, legend: { font: { size: frame.letters }, orientation: "h", x: 0, xanchor: "left", y: 1, yanchor: "bottom" },
      xaxis: { title: { text: plot.x }, zeroline: false, exponentformat: "none" },
      yaxis: { title: { text: plot.y }, exponentformat: "none", zeroline: true, scaleanchor: plot.circle ? "x" : undefined },
    }, { responsive: true, displaylogo: false, displayModeBar: !narrow() && "hover", modeBarButtons: [["toImage", "zoom2d", "pan2d", "resetScale2d"]] });
    charts.push({ div, timed: plot.timed, main: plot.main, curves: plot.curves });
    if (plot.timed) {
      div.on("plotly_relayout", (change) => linkZoom(div, change));
      div.on("plotly_click", (event) => { controls.play(false); const [first, last] = shownRows(); seek(fromFold(Array.from(time.subarray(first, last)), fold())[event.points[0].pointNumber]); });
    }
  }

  controls.labels();
  seek(scene.start);
  window.gudgeon = { ready: false, seek, play: controls.play, charts, scene, get now() { return drawing.now; }, get playing() { return controls.playing; } };
  const library = document.createElement("script");
  library.textContent = new TextDecoder().decode(await unpack("library"));
  document.head.append(library);
  for (const plot of scene.plots) {
    await drawPlot(plot);
    await new Promise((done) => setTimeout(done));   // let the page respond between two plots
  }
  byId("contents").addEventListener("click", (event) => {   // a link to a folded part unfolds it
    const part = event.target.hash && byId(event.target.hash.slice(1));
    if (part && part.tagName === "DETAILS") part.open = true;
  });
  const scrubbed = () => { if (!controls.playing) markPlots(); };
  byId("scrub").addEventListener("change", scrubbed);
  byId("timeline").addEventListener("pointerup", scrubbed);
  byId("abscissa").addEventListener("change", changeAbscissa);
  if (scene.cycle) {   // a page opens on the settled cycle
    byId("abscissa").value = "angle";
    byId("last-cycle").checked = true;
    await changeAbscissa();
  }
  byId("more-plots").hidden = document.querySelector("#contents [href='#more-plots']").hidden = scene.plots.every((plot) => plot.main);
  byId("more-plots").addEventListener("toggle", (event) => { if (event.target.open) charts.forEach(async (c) => { if (!c.main) { await Plotly.Plots.resize(c.div); await Plotly.relayout(c.div, framed(c, false)); } }); });
  // on paper colours are light, and two charts stand beside each other
  const onPaper = (on) => {
    document.documentElement.classList.toggle("on-paper", on);
    recolour((c) => ({ ...framed(c, on), ...(on ? { width: 340, height: c.timed || c.main ? 195 : 270 } : { width: null, height: null, autosize: true }) }));
  };
  window.addEventListener("beforeprint", () => onPaper(true));
  window.addEventListener("afterprint", () => onPaper(false));
  let resized = null;
  window.addEventListener("resize", () => {   // titles and legends follow the width
    clearTimeout(resized);
    resized = setTimeout(() => { if (!document.documentElement.classList.contains("on-paper")) charts.forEach((c) => { if (c.div.clientWidth) Plotly.relayout(c.div, framed(c, false)); }); }, 200);
  });
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { recolour(); markPlots(); });
  byId("last-cycle").addEventListener("change", changeAbscissa);
  window.gudgeon.ready = true;
})().catch((error) => {
  const box = document.getElementById("failure");
  box.hidden = false;
  box.textContent = `The page could not be drawn: ${error}`;
  throw error;
});
