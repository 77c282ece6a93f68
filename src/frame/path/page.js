"use strict";
const element = (id) => document.getElementById(id);
const slider = element("time");
const rows = [...document.querySelectorAll("tbody tr")];
let marked = null;
let timer = 0;
// The last moment at or before a time.
function find(time) {
  let low = 0;
  let high = path.moments.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (path.moments[middle][1] <= time) low = middle;
    else high = middle - 1;
  }
  return low;
}
function show() {
  if (path.moments.length === 0) return;
  const first = path.moments[0][1];
  const time = first + ((path.end - first) * slider.value) / slider.max;
  const index = find(time);
  const from = path.moments[index];
  const next = path.moments[index + 1] || from;
  // A step that begins at an unknown place has one moment: the picture waits at the step before.
  const to = next[0] === from[0] || path.moments[index + 2]?.[0] === next[0] ? next : from;
  const share = to[1] > from[1] ? (time - from[1]) / (to[1] - from[1]) : 0;
  const at = from.slice(2).map((value, axis) => value + (to[axis + 2] - value) * share);
  const step = slider.value === "0" ? 0 : time > from[1] ? to[0] : from[0];
  path.panels.forEach(([x, y, x0, y0, dx, dy], panel) => {
    const left = x0 + (x === null ? time : at[x]) * dx;
    element("dot" + panel).setAttribute("cx", left);
    element("dot" + panel).setAttribute("cy", y0 + at[y] * dy);
    const line = element("then" + panel);
    if (line) line.setAttribute("transform", "translate(" + left + ")");
  });
  const digits = path.unit === "mm" ? 2 : 0;
  const place = at.map((value, axis) => path.axes[axis] + " " + value.toFixed(digits)).join("  ");
  element("now").textContent = (path.timed ? time.toFixed(2) + " s   " : "") + place;
  element("step").textContent = path.points ? "point " + path.steps[step][0] : step + 1 + " · line " + path.steps[step][0];
  element("text").textContent = path.steps[step][1];
  if (marked) marked.classList.remove("is-now");
  marked = rows[step];
  if (marked) marked.classList.add("is-now");
}
function stop() {
  clearInterval(timer);
  timer = 0;
  element("play").textContent = "▶";
}
element("play").addEventListener("click", () => {
  if (timer) return stop();
  if (Number(slider.value) >= Number(slider.max)) slider.value = 0;
  const length = path.timed ? Math.min(Math.max(path.end, 2), 60) : Math.min(Math.max(path.steps.length * 0.6, 2), 60);
  const began = performance.now() - (slider.value / slider.max) * length * 1000;
  element("play").textContent = "❚❚";
  timer = setInterval(() => {
    slider.value = ((performance.now() - began) / length / 1000) * slider.max;
    show();
    if (Number(slider.value) >= Number(slider.max)) stop();
  }, 30);
});
slider.addEventListener("input", () => {
  stop();
  show();
});
rows.forEach((row, step) =>
  row.addEventListener("click", () => {
    const moment = path.moments.findLast((one) => one[0] === step);
    const first = path.moments[0][1];
    slider.value = Math.ceil(((moment[1] - first) / (path.end - first || 1)) * slider.max);
    stop();
    show();
  })
);
show();
