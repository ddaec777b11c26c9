"use strict";
// Values under the pointer, zoom and hidden curves, on the pictures as they stand in the page.
// Loops are no functions of their abscissa, so that chart libraries for series do not draw them.
(() => {
  const NS = "http://www.w3.org/2000/svg";
  const NEAR = 28; // picture units: further off, no curve is meant
  const figures = [];
  const tip = document.createElement("div");
  tip.className = "tip";
  tip.hidden = true;
  document.body.append(tip);

  const short = v => v === 0 ? "0" : String(Number(v.toPrecision(4))).replace("-", "−");

  function toValue(axes, k, place) {
    const [p0, p1] = k ? axes.py : axes.px, [v0, v1] = k ? axes.y : axes.x;
    const share = (place - p0) / (p1 - p0);
    if (!axes.log[k]) return v0 + share * (v1 - v0);
    return Math.exp(Math.log(v0) + share * Math.log(v1 / v0));
  }

  function toPlace(axes, k, value) {
    const [p0, p1] = k ? axes.py : axes.px, [v0, v1] = k ? axes.y : axes.x;
    const share = axes.log[k] ? Math.log(value / v0) / Math.log(v1 / v0) : (value - v0) / (v1 - v0);
    return p0 + share * (p1 - p0);
  }

  // Every number of an axes' drawing, so that a zoom is one linear map of it.
  function parts(group) {
    const found = [];
    for (const node of group.querySelectorAll("[data-series] path, [data-series] use, [data-series]~* path")) {
      if (node.closest("defs") || node.closest("[id*='axis_']")) continue;
      if (node.closest("[id*='patch_']") && !node.closest("[data-series]")) continue;
      found.push({node, d: node.getAttribute("d"), x: +node.getAttribute("x"), y: +node.getAttribute("y")});
    }
    return found;
  }

  function mapped(part, map) {
    const {node, d, x, y} = part;
    if (d === null) {
      const [a, b] = map(x, y);
      node.setAttribute("x", a);
      node.setAttribute("y", b);
    } else {
      node.setAttribute("d", d.replace(/(-?[\d.]+(?:e-?\d+)?)\s+(-?[\d.]+(?:e-?\d+)?)/g, (_, a, b) => {
        const [p, q] = map(+a, +b);
        return p.toFixed(2) + " " + q.toFixed(2);
      }));
    }
  }

  function points(group) {
    const found = [];
    for (const named of group.querySelectorAll("[data-series]")) {
      const at = [];
      for (const use of named.querySelectorAll("use")) at.push([+use.getAttribute("x"), +use.getAttribute("y")]);
      for (const path of named.querySelectorAll("path")) {
        if (path.closest("defs")) continue;
        for (const [, a, b] of path.getAttribute("d").matchAll(/(-?[\d.]+(?:e-?\d+)?)\s+(-?[\d.]+(?:e-?\d+)?)/g)) at.push([+a, +b]);
      }
      found.push({node: named, name: named.dataset.series, at});
    }
    return found;
  }

  function ticks(low, high, log) {
    const all = [], a = Math.min(low, high), b = Math.max(low, high);
    if (log && b / a > 10) {
      for (let e = Math.floor(Math.log10(a)); e <= Math.log10(b); e++)
        for (const m of [1, 2, 5]) all.push(m * 10 ** e);
    } else {
      const raw = (b - a) / 4, base = 10 ** Math.floor(Math.log10(raw));
      const step = base * [1, 2, 5, 10].find(m => m * base >= raw);
      for (let v = Math.ceil(a / step) * step; v <= b; v += step) all.push(v);
    }
    return all.filter(v => v >= a && v <= b);
  }

  function ownTicks(figure, axes) {
    const group = axes.group;
    group.querySelectorAll(".own-ticks").forEach(n => n.remove());
    const hide = axes.zoomed ? "none" : "";
    for (const tick of group.querySelectorAll("[id*='xtick_'], [id*='ytick_']")) tick.style.display = hide;
    if (!axes.zoomed) return;
    const drawn = document.createElementNS(NS, "g");
    drawn.setAttribute("class", "own-ticks");
    for (const k of [0, 1]) {
      const [low, high] = k ? axes.y : axes.x;
      for (const v of ticks(low, high, axes.log[k])) {
        const text = document.createElementNS(NS, "text"), p = toPlace(axes, k, v);
        text.textContent = k && axes.names ? axes.names[Math.round(v)] ?? "" : short(v);
        text.setAttribute("x", k ? axes.px[0] - 4 : p);
        text.setAttribute("y", k ? p + 3 : axes.py[0] + 11);
        text.setAttribute("text-anchor", k ? "end" : "middle");
        drawn.append(text);
      }
    }
    group.append(drawn);
  }

  function zoom(figure, axes, box) {
    const whole = axes.whole;
    if (box) {
      const x = [toValue(axes, 0, box[0]), toValue(axes, 0, box[2])];
      const y = [toValue(axes, 1, box[3]), toValue(axes, 1, box[1])];
      [axes.x, axes.y, axes.zoomed] = [x, y, true];
    } else {
      [axes.x, axes.y, axes.zoomed] = [whole.x, whole.y, false];
    }
    const view = {px: axes.px, py: axes.py, log: axes.log, x: axes.x, y: axes.y};
    const ends = k => {
      const w = k ? whole.y : whole.x, p = k ? axes.py : axes.px;
      const q = w.map(v => toPlace(view, k, v));
      return s => q[0] + (s - p[0]) / (p[1] - p[0]) * (q[1] - q[0]);
    };
    const fx = ends(0), fy = ends(1);
    axes.parts.forEach(part => mapped(part, (a, b) => [fx(a), fy(b)]));
    axes.curves = points(axes.group);
    ownTicks(figure, axes);
    figure.reset.hidden = !figure.axes.some(a => a.zoomed);
  }

  function inPicture(svg, event) {
    const p = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    return [p.x, p.y];
  }

  const under = (figure, [x, y]) => figure.axes.find(a =>
    x >= a.px[0] && x <= a.px[1] && y <= a.py[0] && y >= a.py[1]);

  function told(figure, event) {
    const at = inPicture(figure.svg, event), axes = under(figure, at);
    let best = null, least = NEAR * NEAR;
    for (const curve of axes ? axes.curves : []) {
      if (curve.node.style.display === "none") continue;
      for (const p of curve.at) {
        const off = (p[0] - at[0]) ** 2 + (p[1] - at[1]) ** 2;
        if (off < least) [least, best] = [off, {curve, p}];
      }
    }
    figure.mark.style.display = best ? "" : "none";
    tip.hidden = !best;
    if (!best) return;
    figure.mark.setAttribute("cx", best.p[0]);
    figure.mark.setAttribute("cy", best.p[1]);
    const y = toValue(axes, 1, best.p[1]);
    const row = axes.names ? axes.names[Math.round(y)] ?? "" : `${axes.label[1]}: ${short(y)}`;
    tip.textContent = `${best.curve.name}\n${axes.label[0]}: ${short(toValue(axes, 0, best.p[0]))}\n${row}`;
    const left = event.clientX + 14, over = left + tip.offsetWidth - document.documentElement.clientWidth + 8;
    tip.style.left = Math.max(4, left - Math.max(0, over)) + "px";
    tip.style.top = event.clientY + 16 + "px";
  }

  function rubber(figure) {
    const {svg} = figure;
    let from = null, box = null, axes = null;
    svg.addEventListener("pointerdown", event => {
      if (event.pointerType === "touch" || event.button) return; // a finger scrolls the page
      from = inPicture(svg, event);
      axes = under(figure, from);
      if (axes) event.preventDefault();
    });
    svg.addEventListener("pointermove", event => {
      told(figure, event);
      if (!axes || !from) return;
      const [x, y] = inPicture(svg, event);
      const clamp = (v, [a, b]) => Math.min(Math.max(v, Math.min(a, b)), Math.max(a, b));
      const to = [clamp(x, axes.px), clamp(y, axes.py)];
      box = [Math.min(from[0], to[0]), Math.min(from[1], to[1]), Math.max(from[0], to[0]), Math.max(from[1], to[1])];
      Object.entries({x: box[0], y: box[1], width: box[2] - box[0], height: box[3] - box[1]})
        .forEach(([k, v]) => figure.rubber.setAttribute(k, v));
      figure.rubber.style.display = "";
    });
    window.addEventListener("pointerup", () => {
      figure.rubber.style.display = "none";
      if (axes && box && box[2] - box[0] > 6 && box[3] - box[1] > 6) zoom(figure, axes, box);
      from = box = axes = null;
    });
    svg.addEventListener("pointerleave", () => { tip.hidden = true; figure.mark.style.display = "none"; });
    svg.addEventListener("dblclick", () => figure.axes.forEach(a => zoom(figure, a, null)));
  }

  function shape(svg, tag, name) {
    const node = document.createElementNS(NS, tag);
    node.setAttribute("class", name);
    node.style.display = "none";
    svg.append(node);
    return node;
  }

  function toggle(name) {
    const hidden = !document.querySelector(`[data-toggle="${CSS.escape(name)}"][aria-pressed="false"]`);
    document.querySelectorAll(`[data-toggle="${CSS.escape(name)}"]`)
      .forEach(b => b.setAttribute("aria-pressed", String(!hidden)));
    document.querySelectorAll(`[data-series="${CSS.escape(name)}"]`)
      .forEach(n => { n.style.display = hidden ? "none" : ""; });
  }

  function button(text, pressed) {
    const made = document.createElement("button");
    made.type = "button";
    made.textContent = text;
    if (pressed !== undefined) made.setAttribute("aria-pressed", String(pressed));
    return made;
  }

  document.querySelectorAll("svg[data-axes]").forEach(svg => {
    const name = svg.querySelector("[id$='-figure_1']").id.replace(/figure_1$/, "");
    const figure = {svg, mark: shape(svg, "circle", "mark"), rubber: shape(svg, "rect", "rubber")};
    figure.mark.setAttribute("r", "3.2");
    figure.axes = JSON.parse(svg.dataset.axes).map(axes => {
      const group = document.getElementById(`${name}axes_${axes.n}`);
      return {...axes, group, whole: {x: axes.x, y: axes.y}, parts: parts(group), curves: points(group)};
    });
    const bar = document.createElement("div");
    bar.className = "chips";
    const names = [...new Set([...svg.querySelectorAll("[data-series]")].map(n => n.dataset.series))];
    if (names.length > 1) for (const one of names) {
      const chip = button(one, true);
      chip.dataset.toggle = one;
      chip.addEventListener("click", () => toggle(one));
      bar.append(chip);
    }
    figure.reset = button("Whole picture");
    figure.reset.hidden = true;
    figure.reset.className = "reset";
    figure.reset.addEventListener("click", () => figure.axes.forEach(a => zoom(figure, a, null)));
    bar.append(figure.reset);
    svg.after(bar);
    rubber(figure);
    figures.push(figure);
  });
})();
