"use strict";
const charts = JSON.parse(document.getElementById("charts").textContent);
const W = 1000, H = 260, L = 64, R = 14, T = 10, B = 40;
const color = (index) => `var(--s${index % 6})`;
const node = (name, attributes, parent) => {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const key in attributes) made.setAttribute(key, attributes[key]);
  if (parent) parent.appendChild(made);
  return made;
};
const ticks = (low, high, count) => {
  const raw = (high - low) / count, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((part) => part * power).find((part) => part >= raw) || raw;
  const found = [];
  for (let at = Math.ceil(low / step - 1e-9) * step; at <= high + 1e-9 * step; at += step) found.push(at);
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  return found.map((at) => [at, at.toFixed(Math.min(digits, 8))]);
};
// One chart. Charts of a group zoom together along x.
const zooms = {};
const draw = (figure, chart) => {
  const shown = chart.series.filter((series) => series.x.length);
  const all = shown.flatMap((series) => [series.x[0], series.x[series.x.length - 1]]);
  const whole = all.length ? [Math.min(...all), Math.max(...all)] : [0, 1];
  const [x0, x1] = zooms[chart.group] || whole;
  let y0 = Infinity, y1 = -Infinity;
  for (const series of shown) series.x.forEach((x, index) => {
    const y = series.y[index];
    if (x >= x0 && x <= x1 && y !== null) { y0 = Math.min(y0, y); y1 = Math.max(y1, y); }
  });
  if (!(y0 < y1)) { const middle = Number.isFinite(y0) ? y0 : 0; y0 = middle - 1; y1 = middle + 1; }
  if (chart.from_zero) y0 = Math.min(0, y0);
  // A limit is drawn as far as it fits: the data have at least a third of the height.
  for (const limit of chart.limits) if (Math.abs(limit.y) <= 3 * Math.max(Math.abs(y0), Math.abs(y1))) { y0 = Math.min(y0, limit.y); y1 = Math.max(y1, limit.y); }
  const pad = chart.bars ? 0 : 0.06 * (y1 - y0); y0 -= pad; y1 += 0.06 * (y1 - y0);
  const px = (x) => L + (x - x0) / (x1 - x0 || 1) * (W - L - R), py = (y) => T + (y1 - y) / (y1 - y0) * (H - T - B);
  const svg = node("svg", { viewBox: `0 0 ${W} ${H}`, role: "img", "aria-label": chart.title });
  const clip = `c${Math.random().toString(36).slice(2)}`;
  node("rect", { x: L, y: T, width: W - L - R, height: H - T - B }, node("clipPath", { id: clip }, svg));
  const plot = node("g", { "clip-path": `url(#${clip})` }, svg);
  if (chart.band) {
    const top = Math.max(T, py(chart.band[1])), bottom = Math.min(H - B, py(chart.band[0]));
    if (bottom > top) node("rect", { class: "band", x: L, width: W - L - R, y: top, height: bottom - top }, plot);
  }
  for (const [at, name] of ticks(x0, x1, 8)) {
    node("line", { class: "grid", x1: px(at), x2: px(at), y1: T, y2: H - B }, svg);
    node("text", { x: px(at), y: H - B + 15, "text-anchor": "middle" }, svg).textContent = name;
  }
  for (const [at, name] of ticks(y0, y1, 5)) {
    node("line", { class: "grid", x1: L, x2: W - R, y1: py(at), y2: py(at) }, svg);
    node("text", { x: L - 6, y: py(at) + 4, "text-anchor": "end" }, svg).textContent = name;
  }
  if (y0 < 0 && y1 > 0) node("line", { class: "zero", x1: L, x2: W - R, y1: py(0), y2: py(0) }, svg);
  shown.forEach((series) => {
    const index = chart.series.indexOf(series);
    if (chart.bars) {
      const width = Math.max(1, (px(series.x[1] ?? x1) - px(series.x[0])) - 1);
      series.x.forEach((x, at) => node("rect", { x: px(x), y: py(series.y[at]), width, height: Math.max(0, py(0) - py(series.y[at])), fill: color(index) }, plot));
      return;
    }
    let path = "", pen = false;
    series.x.forEach((x, at) => {
      const y = series.y[at];
      if (y === null) { pen = false; return; }
      path += `${pen ? "L" : "M"}${px(x).toFixed(1)} ${py(y).toFixed(1)}`; pen = true;
    });
    node("path", { class: "data", d: path, stroke: color(index) }, plot);
  });
  for (const limit of chart.limits) if (limit.y > y0 && limit.y < y1) {
    node("line", { class: "limit", x1: L, x2: W - R, y1: py(limit.y), y2: py(limit.y) }, plot);
    node("text", { x: W - R - 4, y: py(limit.y) - 4, "text-anchor": "end" }, plot).textContent = limit.name;
  }
  for (const limit of chart.x_limits || []) if (limit.y > x0 && limit.y < x1) {
    node("line", { class: "limit", x1: px(limit.y), x2: px(limit.y), y1: T, y2: H - B }, plot);
    node("text", { x: px(limit.y) + 4, y: T + 12 }, plot).textContent = limit.name;
  }
  node("rect", { class: "frame", x: L, y: T, width: W - L - R, height: H - T - B }, svg);
  node("text", { x: (L + W - R) / 2, y: H - 6, "text-anchor": "middle" }, svg).textContent = chart.x_label;
  node("text", { x: 12, y: (T + H - B) / 2, transform: `rotate(-90 12 ${(T + H - B) / 2})`, "text-anchor": "middle" }, svg).textContent = chart.y_label;
  const at = (event) => { const box = svg.getBoundingClientRect(); return x0 + ((event.clientX - box.left) / box.width * W - L) / (W - L - R) * (x1 - x0); };
  let from = null, brush = null;
  svg.addEventListener("pointerdown", (event) => { from = at(event); brush = node("rect", { class: "brush", y: T, height: H - T - B, x: px(from), width: 0 }, svg); svg.setPointerCapture(event.pointerId); });
  svg.addEventListener("pointermove", (event) => { if (from === null) return; const to = at(event); brush.setAttribute("x", px(Math.min(from, to))); brush.setAttribute("width", Math.abs(px(to) - px(from))); });
  svg.addEventListener("pointerup", (event) => { if (from === null) return; const to = at(event); if (Math.abs(px(to) - px(from)) > 6) zooms[chart.group] = [Math.min(from, to), Math.max(from, to)]; from = null; redraw(chart.group); });
  svg.addEventListener("dblclick", () => { delete zooms[chart.group]; redraw(chart.group); });
  const old = figure.querySelector("svg");
  if (old) old.replaceWith(svg); else figure.appendChild(svg);
};
const figures = [];
const redraw = (group) => figures.forEach(([figure, chart]) => { if (chart.group === group) draw(figure, chart); });
const fill = (holder, list) => {
  holder.textContent = "";
  for (const chart of list) {
    const figure = document.createElement("figure"), caption = document.createElement("figcaption");
    caption.textContent = chart.title;
    chart.series.forEach((series, index) => {
      if (chart.series.length < 2) return;
      const key = document.createElement("span"), line = document.createElement("i");
      line.style.background = color(index); key.append(line, series.name); caption.appendChild(key);
    });
    figure.appendChild(caption); holder.appendChild(figure); figures.push([figure, chart]); draw(figure, chart);
  }
};
for (const holder of document.querySelectorAll("[data-charts]")) {
  const sets = charts[Number(holder.dataset.charts)];
  const body = document.createElement("div");
  if (sets.length > 1) {
    const choice = document.createElement("select");
    choice.setAttribute("aria-label", "hole");
    sets.forEach((set, index) => choice.add(new Option(set.name, index)));
    choice.addEventListener("change", () => { const kept = figures.filter(([figure]) => !body.contains(figure)); figures.length = 0; figures.push(...kept); fill(body, sets[choice.value].charts); });
    holder.appendChild(choice);
  }
  holder.appendChild(body);
  fill(body, sets[0].charts);
}
