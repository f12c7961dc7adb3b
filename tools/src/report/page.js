"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const byId = (id) => document.getElementById(id);
  const SVG = "http://www.w3.org/2000/svg";
  // Beyond these the tracks are folded, and drawn when they are asked for.
  const OPEN_TRACKS = 16;
  // The room for the numbers of a scale, left of its track.
  const SCALE = 48;

  // An element with attributes, and with children that are elements or text. Text is never HTML.
  function make(tag, attributes = {}, ...children) {
    const drawn = ["svg", "g", "path", "rect", "line", "text", "circle", "title"].includes(tag);
    const element = drawn ? document.createElementNS(SVG, tag) : document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    element.append(...children);
    return element;
  }

  // A number as a reader wants it: at most five digits.
  function shown(value) {
    if (value === Infinity) return "∞";
    if (value === -Infinity) return "−∞";
    return String(Number(value.toPrecision(5))).replace("-", "−");
  }

  const numbers = (column) => column && column.map(Number);
  const trajectories = data.trajectories.map((one) => ({
    ...one,
    rho: one.rho && one.rho.map(numbers),
    low: one.low && one.low.map(numbers),
    high: one.high && one.high.map(numbers),
    so_far: numbers(one.so_far),
    greatest: numbers(one.greatest),
    robustness: one.robustness === null ? null : Number(one.robustness),
    rows: one.last[one.last.length - 1] + 1,
  }));
  if (trajectories.length === 0) return;

  let one = trajectories[0];
  let at = 0; // the piece at the cursor
  let tracks = []; // what is redrawn when the width or the trajectory changes
  let width = 0;

  const place = (row) => SCALE + (row / one.rows) * (width - SCALE);
  const middle = (i) => place((one.first[i] + one.last[i] + 1) / 2);

  function verdictAt(i) {
    const q = one.states[i];
    if (q === null) return one.verdict === "satisfied" && one.last[i] >= one.since ? "satisfied" : "not satisfied yet";
    if (q === data.accepting) return "satisfied";
    return q === data.trap ? "lost" : "open";
  }

  // The fewer moves are left, the stronger the colour.
  const most = Math.max(1, ...Object.values(data.moves));
  function strength(q) {
    const left = data.moves[q];
    return left === undefined ? 15 : Math.round(85 - (60 * (left - 1)) / most);
  }

  function colour(q) {
    if (q === data.accepting) return "var(--good)";
    if (q === data.trap) return "var(--bad)";
    return `color-mix(in srgb, var(--mark) ${strength(q)}%, var(--ground))`;
  }

  // The runs of equal values of a column: [value, first piece, last piece].
  function runs(column) {
    const found = [];
    column.forEach((value, i) => {
      const last = found[found.length - 1];
      if (last && last[0] === value) last[2] = i;
      else found.push([value, i, i]);
    });
    return found;
  }

  function strip(svg) {
    for (const [q, from, to] of runs(one.states)) {
      const [x, end] = [place(one.first[from]), place(one.last[to] + 1)];
      const block = make("rect", { x, y: 2, width: Math.max(end - x, 0.5), height: 22, rx: Math.min(3, (end - x) / 4) });
      block.style.fill = colour(q);
      block.append(make("title", {}, `state ${q}, rows ${one.first[from]} to ${one.last[to]}`));
      svg.append(block);
      if (end - x > 8 + 7 * String(q).length) {
        const pale = q !== data.accepting && q !== data.trap && strength(q) < 60;
        svg.append(make("text", { x: (x + end) / 2, y: 17, class: pale ? "on pale" : "on" }, String(q)));
      }
    }
  }

  function axis(svg) {
    const about = one.rows / Math.max(1, Math.floor((width - SCALE) / 90));
    const ten = 10 ** Math.floor(Math.log10(Math.max(about, 1)));
    const step = [1, 2, 5, 10].map((m) => m * ten).find((s) => s >= about) || 1;
    for (let row = 0; row < one.rows; row += step) {
      const x = place(row + 0.5);
      if (x > width - 8 && row > 0) break;
      svg.append(make("text", { x, y: 12, class: "mid" }, String(row)));
    }
  }

  // The scale of some columns, zero among them; infinite values stand at the edges.
  function scale(columns, height) {
    let [low, high] = [0, 0];
    for (const column of columns) {
      for (const value of column) {
        if (value < low && value > -Infinity) low = value;
        if (value > high && value < Infinity) high = value;
      }
    }
    if (low === high) [low, high] = [-1, 1];
    const room = height - 10;
    const y = (value) => {
      if (Math.abs(value) === Infinity) return value < 0 ? height - 0.5 : 0.5;
      return 5 + ((high - value) / (high - low)) * room;
    };
    return { y, low, high };
  }

  // A line through the middles of the pieces, level at both ends.
  function line(y, values) {
    const points = values.map((value, i) => `${middle(i).toFixed(1)} ${y(value).toFixed(1)}`);
    const [first, last] = [y(values[0]).toFixed(1), y(values[values.length - 1]).toFixed(1)];
    return `M${SCALE} ${first}L${points.join("L")}L${width.toFixed(1)} ${last}`;
  }

  // A line that holds each value to the end of its piece.
  function stairs(y, values) {
    return values
      .map((value, i) => `${i ? "L" : "M"}${place(one.first[i]).toFixed(1)} ${y(value).toFixed(1)}H${place(one.last[i] + 1).toFixed(1)}`)
      .join("");
  }

  // The area between two lines of the same form.
  function area(form, y, upper, lower) {
    const points = (path) => path.slice(1).split("L");
    const back = points(form(y, lower).replace(/ ([\d.-]+)H([\d.-]+)/g, " $1L$2 $1")).reverse();
    return `${form(y, upper).replace(/ ([\d.-]+)H([\d.-]+)/g, " $1L$2 $1")}L${back.join("L")}Z`;
  }

  function frame(svg, { y, low, high }, height) {
    svg.append(make("line", { class: "zero", x1: SCALE, x2: width, y1: y(0), y2: y(0) }));
    const [top, bottom] = [high, low].map((end) => shown(Number(end.toPrecision(3))));
    svg.append(make("text", { class: "scale", x: SCALE - 6, y: 11 }, top));
    svg.append(make("text", { class: "scale", x: SCALE - 6, y: height - 3 }, bottom));
  }

  function predicate(p) {
    return (svg, height) => {
      if (!one.rho) {
        svg.append(make("rect", { class: "ground", x: SCALE, y: height / 2 - 6, width: width - SCALE, height: 12, rx: 3 }));
        for (const [digit, from, to] of runs([...one.holds[p]])) {
          if (digit === "0") continue;
          const x = place(one.first[from]);
          svg.append(make("rect", { class: "held", x, y: height / 2 - 6, width: place(one.last[to] + 1) - x, height: 12, rx: 3 }));
        }
        return;
      }
      const [low, high] = [(one.low || one.rho)[p], (one.high || one.rho)[p]];
      const fit = scale([low, high], height);
      frame(svg, fit, height);
      const [level, zero] = [fit.y(0), low.map(() => 0)];
      // Each side of zero is cut off at zero, for lines cross it between two rows.
      const above = make("path", { class: "above", d: area(line, fit.y, high, zero) });
      const below = make("path", { class: "below", d: area(line, fit.y, low, zero) });
      const [top, bottom] = [level, height - level].map((room) => Math.max(room, 0));
      svg.append(make("svg", { x: 0, y: 0, width, height: top }, above));
      const view = `0 ${level} ${width} ${bottom}`;
      svg.append(make("svg", { x: 0, y: level, width, height: bottom, viewBox: view }, below));
      const curve = one.low ? { class: "band", d: area(line, fit.y, high, low) } : { class: "curve", d: line(fit.y, high) };
      svg.append(make("path", curve));
    };
  }

  function robustness(svg, height) {
    const columns = one.greatest ? [one.so_far, one.greatest] : [one.so_far];
    const fit = scale(columns, height);
    frame(svg, fit, height);
    if (one.greatest) {
      svg.append(make("path", { class: "between", d: area(stairs, fit.y, one.greatest, one.so_far) }));
      svg.append(make("path", { class: "reach", d: stairs(fit.y, one.greatest) }));
    }
    svg.append(make("path", { class: "curve", d: stairs(fit.y, one.so_far) }));
  }

  function track(parent, name, height, draw, value) {
    const told = make("span", { class: "value" });
    const svg = make("svg", { height, role: "img", "aria-label": `${name} over time` });
    const label = make("div", { class: "label", title: name }, make("span", { class: "name" }, name), told);
    parent.append(make("div", { class: "track" }, label, svg));
    tracks.push({ svg, height, draw, told, value });
  }

  function values(p) {
    return (i, told) => {
      const holds = one.holds[p][i] === "1";
      told.className = holds ? "value holds" : "value";
      const number = one.rho ? `${shown(one.rho[p][i])}, ` : "";
      return number + (holds ? "holds" : "does not hold");
    };
  }

  const room = byId("tracks");
  const cursor = make("div", { id: "cursor" });
  const plot = make("div", { id: "plot" });

  function build() {
    tracks = [];
    plot.replaceChildren(cursor);
    room.replaceChildren(plot);
    if (one.states[0] !== null) track(plot, "state", 26, strip, (i) => String(one.states[i]));
    const few = data.propositions.slice(0, OPEN_TRACKS);
    const height = one.rho ? 52 : 26;
    few.forEach((name, p) => track(plot, name, height, predicate(p), values(p)));
    const more = data.propositions.slice(OPEN_TRACKS);
    if (more.length > 0) {
      const folded = make("details", { class: "tracks" }, make("summary", {}, `${more.length} more predicates`));
      more.forEach((name, p) => track(folded, name, height, predicate(p + OPEN_TRACKS), values(p + OPEN_TRACKS)));
      folded.addEventListener("toggle", draw);
      plot.append(folded);
    }
    if (one.so_far) {
      track(plot, "robustness so far", 84, robustness, (i) => {
        const reach = one.greatest ? `, can become ${shown(one.greatest[i])}` : "";
        return shown(one.so_far[i]) + reach;
      });
    }
    track(plot, "row", 16, axis, () => "");
    const key = make("p", { class: "key" });
    const entry = (style, text) => {
      const sample = make("i");
      sample.style.background = style;
      key.append(make("span", {}, sample, text));
    };
    if (one.rho) {
      entry("color-mix(in srgb, var(--good) 40%, var(--card))", "holds, by so much");
      entry("color-mix(in srgb, var(--soft) 25%, var(--card))", "does not hold, by so much");
    } else entry("var(--good)", "holds");
    if (one.states[0] !== null) entry("var(--mark)", "state after the row: the stronger, the fewer moves are left");
    if (one.greatest) entry("var(--mark-ground)", "robustness so far, and dashed what it can still become");
    room.append(key);
    const end = one.verdict || "not satisfied, and perhaps lost";
    const reached = end === "open" ? "not satisfied yet, and not lost" : one.verdict ? `${end} at row ${one.since}` : end;
    const worth = one.robustness === null ? "" : `; robustness ${shown(one.robustness)}`;
    room.append(make("p", { class: "note", id: "end" }, `In the end: ${reached}${worth}.`));
    if (one.rule) room.append(make("p", { class: "note" }, `${one.rule}.`));
    if (data.of > trajectories.length) {
      room.append(make("p", { class: "note" }, `The first ${trajectories.length} of ${data.of} trajectories are here.`));
    }
    draw();
  }

  function draw() {
    const seen = tracks.filter(({ svg }) => svg.getBoundingClientRect().width > 0);
    if (seen.length === 0) return;
    width = seen[0].svg.getBoundingClientRect().width;
    for (const { svg, height, draw } of seen) {
      svg.replaceChildren();
      svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
      draw(svg, height);
    }
    move(at);
  }

  const slider = make("input", { type: "range", id: "slider", min: 0, step: 1, "aria-label": "row of the trajectory" });
  const output = make("output", { for: "slider", id: "row" });
  const verdict = make("span", { class: "pill", id: "verdict" });
  const back = make("button", { type: "button", title: "to the last change of state" }, "‹ change");
  const on = make("button", { type: "button", title: "to the next change of state" }, "change ›");
  const choice = make("select", { id: "trajectory", "aria-label": "trajectory" });
  trajectories.forEach((each, i) => {
    choice.append(make("option", { value: i }, `${each.name}: ${each.verdict || "not satisfied"}`));
  });

  function change(step) {
    for (let i = at + step; i >= 0 && i < one.states.length; i += step) {
      if (one.states[i] !== one.states[i - 1]) return i;
    }
    return null;
  }

  // Shows everything as of a piece.
  function move(to) {
    at = Math.min(Math.max(to, 0), one.first.length - 1);
    const [first, last] = [one.first[at], one.last[at]];
    slider.value = at;
    const rows = first === last ? `row ${last}` : `rows ${first}–${last}`;
    output.value = `${rows} of ${one.rows}`;
    slider.setAttribute("aria-valuetext", output.value);
    const word = verdictAt(at);
    verdict.textContent = word;
    verdict.className = `pill ${word.split(" ").length > 1 ? "open" : word}`;
    back.disabled = change(-1) === null;
    on.disabled = change(1) === null;
    for (const { told, value } of tracks) told.textContent = value(at, told);
    if (tracks.length > 0 && width > 0) {
      const left = tracks[0].svg.getBoundingClientRect().left - plot.getBoundingClientRect().left;
      const [x, end] = [place(first), place(last + 1)];
      cursor.className = end - x < 3 ? "thin" : "";
      cursor.style.left = `${left + x}px`;
      cursor.style.width = `${end - x}px`;
    }
    ask(one.states[at]);
  }

  // What the state asks for, and where it is in the picture.
  function ask(q) {
    const [now, here] = [byId("now"), byId("here")];
    if (q === null || !now) return;
    now.hidden = false;
    const asks = document.querySelector(`#asks [data-state="${q}"]`);
    const state = make("b", { class: `state ${verdictAt(at)}`, id: "state" }, String(q));
    const text = asks ? asks.querySelector("dl").cloneNode(true) : make("p", { class: "note" }, "This state is not explained: too many are.");
    now.replaceChildren(make("h2", {}, "What is still asked for in state ", state), text);
    // Large automata have no picture.
    if (!here) return;
    here.replaceChildren();
    const circle = data.circles.find(([state]) => state === q);
    if (!circle) return;
    const [, cx, cy, r] = circle;
    here.append(make("circle", { cx, cy, r: r + 3 }));
    const scroll = document.querySelector("#automaton .scroll");
    if (scroll.scrollWidth > scroll.clientWidth || scroll.scrollHeight > scroll.clientHeight) {
      scroll.scrollTo({ left: cx - scroll.clientWidth / 2, top: cy - scroll.clientHeight / 2 });
    }
  }

  function choose(i) {
    one = trajectories[i];
    at = 0;
    slider.max = one.first.length - 1;
    build();
  }

  function point(event) {
    const x = event.clientX - tracks[0].svg.getBoundingClientRect().left;
    const row = ((x - SCALE) / (width - SCALE)) * one.rows;
    const found = one.last.findIndex((last) => row < last + 1);
    move(row < 0 ? 0 : found < 0 ? one.first.length - 1 : found);
  }

  slider.addEventListener("input", () => move(Number(slider.value)));
  back.addEventListener("click", () => move(change(-1)));
  on.addEventListener("click", () => move(change(1)));
  choice.addEventListener("change", () => choose(Number(choice.value)));
  plot.addEventListener("pointerdown", (event) => {
    if (event.target.closest("svg")) point(event);
  });
  plot.addEventListener("pointermove", (event) => {
    if (event.buttons & 1 && event.target.closest("svg")) point(event);
  });
  window.addEventListener("resize", draw);

  const player = byId("player");
  if (trajectories.length > 1) player.append(choice);
  if (trajectories.some(({ states }) => states[0] !== null)) player.append(back, on);
  player.append(slider, output, verdict);
  player.hidden = room.hidden = false;
  choose(0);
})();
