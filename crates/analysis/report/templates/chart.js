"use strict";
// Charts: values under the pointer, linked cursors, zoom, an outline of the ship along the track,
// downloads. The server has drawn every chart; without this script it stays as it is.
(() => {
// Half of the outline of a ship from bow to stern, as fractions of length and beam.
const HALF = [[.5, 0], [.42, .24], [.3, .44], [.18, .5], [-.38, .5], [-.5, .36]];
const OUTLINE = [...HALF, ...HALF.slice(1).reverse().map(([x, y]) => [x, -y])];
const STYLES = ["fill", "fill-opacity", "stroke", "stroke-width", "stroke-dasharray", "stroke-opacity",
  "stroke-linecap", "stroke-linejoin", "font-family", "font-size", "font-weight", "text-anchor", "paint-order", "display", "vector-effect"];

// Words in the language of the page, where it has any; a report has the English ones.
const WORDS = JSON.parse(document.getElementById("chart-words")?.textContent ?? "{}");
const say = (text) => WORDS[text] ?? text;
const MARK = ["de", "nb"].includes(document.documentElement.lang) ? "," : ".";
const local = (number) => number.replace(".", MARK);

const draw = (name, attributes, parent) => {
  const node = document.createElementNS(parent.namespaceURI, name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  parent.append(node);
  return node;
};
const make = (name, properties, parent) => {
  const node = Object.assign(document.createElement(name), properties);
  parent.append(node);
  return node;
};
// Values are an exponent of ten, and differences of successive values in that resolution.
const decode = ([exponent, ...steps]) => {
  let sum = 0;
  return { decimals: Math.max(0, -exponent),
    list: steps.map((step) => step === null ? NaN : (sum += step) * 10 ** exponent) };
};
const text = (values, index, most = 3) => {
  const value = values?.list[index];
  return Number.isFinite(value) ? value.toFixed(Math.min(values.decimals, most)) : "";
};
// Index of the value of an increasing list that is nearest to another value.
const nearest = (list, value) => {
  let low = 0, high = list.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (list[middle] > value) high = middle; else low = middle;
  }
  return Math.abs(list[high] - value) < Math.abs(list[low] - value) ? high : low;
};
const ticks = (low, high, about) => {
  const least = (high - low) / about, power = 10 ** Math.floor(Math.log10(least));
  const step = [1, 2, 5, 10].find((k) => k * power >= least * .999) * power;
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9)), all = [];
  for (let k = Math.ceil(low / step); k * step <= high; k++) all.push([k * step, local((k * step).toFixed(decimals))]);
  return all;
};

class Panel {
  constructor(element) {
    const number = (name) => element.getAttribute(name).split(" ").map(Number);
    this.element = element;
    this.plot = element.ownerSVGElement;
    this.quantity = element.dataset.quantity;
    this.title = element.dataset.title;
    this.unit = element.dataset.unit;
    [this.left, this.top, this.width, this.height] = ["x", "y", "width", "height"].flatMap(number);
    [this.across, this.up] = ["data-across", "data-up"].map(number);
    this.isGround = this.quantity === "ground";
    this.overlay = draw("g", {}, element);
    this.show([0, 0, this.width, this.height]);
  }
  x(value) { return (value - this.across[0]) / (this.across[1] - this.across[0]) * this.width; }
  y(value) { return (this.up[1] - value) / (this.up[1] - this.up[0]) * this.height; }
  acrossAt(x) { return this.across[0] + x / this.width * (this.across[1] - this.across[0]); }
  upAt(y) { return this.up[1] - y / this.height * (this.up[1] - this.up[0]); }
  // Shows a part of the panel.
  show(part) {
    this.part = part;
    this.element.setAttribute("viewBox", part.join(" "));
    this.element.setAttribute("preserveAspectRatio", "none");
    this.element.classList.toggle("zoomed", part[2] !== this.width);
  }
  // Position in the panel of a pointer; nothing outside.
  locate(event) {
    const matrix = this.plot.getScreenCTM();
    if (!matrix) return null;
    const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix.inverse());
    const [x, y] = [(at.x - this.left) / this.width, (at.y - this.top) / this.height];
    const [left, top, width, height] = this.part;
    const inside = x >= 0 && x <= 1 && y >= 0 && y <= 1;
    return { x: left + x * width, y: top + y * height, inside };
  }
  // Grid and labels of the part that is shown, in the place of those of the whole.
  grid(layer, labelled) {
    const [left, top, width, height] = this.part;
    for (const [value, label] of ticks(this.acrossAt(left), this.acrossAt(left + width), 6)) {
      const x = this.left + (this.x(value) - left) / width * this.width, bottom = this.top + this.height;
      draw("path", { class: "grid", d: `M${x} ${this.top}V${bottom}` }, layer);
      if (labelled) draw("text", { class: "tick mid", x, y: bottom + 14 }, layer).textContent = label;
    }
    for (const [value, label] of ticks(this.upAt(top + height), this.upAt(top), this.isGround ? 8 : 4)) {
      const y = this.top + (this.y(value) - top) / height * this.height;
      draw("path", { class: "grid", d: `M${this.left} ${y}H${this.left + this.width}` }, layer);
      draw("text", { class: "tick end", x: this.left - 6, y: y + 3.6 }, layer).textContent = label;
    }
  }
}

class Chart {
  constructor(root) {
    const data = JSON.parse(root.querySelector("script").textContent);
    this.root = root;
    this.hull = data.hull;
    this.hidden = new Set();
    this.lines = data.lines.map((line) => ({ ...line,
      values: Object.fromEntries(Object.entries(line.values).map(([name, list]) => [name, decode(list)])) }));
    this.classes = [...new Set(this.lines.map((line) => line.class))];
    this.panels = [...root.querySelectorAll("svg[data-quantity]")].map((element) => new Panel(element));
    this.plots = [...new Set(this.panels.map((panel) => panel.plot))];
    const times = this.lines.flatMap((line) => [line.values.t.list[0], line.values.t.list.at(-1)]).filter(Number.isFinite);
    [this.from, this.to] = [Math.min(...times), Math.max(...times)];
    this.legend();
    this.tools();
    for (const plot of this.plots) this.listen(plot);
    this.table();
    this.setTime(this.from);
  }
  visible() { return this.lines.filter((line) => !this.hidden.has(line.class)); }
  legend() {
    for (const entry of this.root.querySelectorAll(".legend > span")) {
      const name = this.classes.find((name) => entry.querySelector("." + name));
      if (!name) continue;
      entry.tabIndex = 0;
      entry.setAttribute("role", "button");
      entry.setAttribute("aria-pressed", "true");
      entry.title = say("Show or hide");
      const toggle = () => {
        if (!this.hidden.delete(name)) this.hidden.add(name);
        entry.setAttribute("aria-pressed", String(!this.hidden.has(name)));
        for (const panel of this.panels)
          for (const part of panel.element.querySelectorAll("." + name)) part.style.display = this.hidden.has(name) ? "none" : "";
        this.setTime(this.time);
      };
      entry.addEventListener("click", toggle);
      entry.addEventListener("keydown", (event) => {
        if (event.key === "Enter" || event.key === " ") { event.preventDefault(); toggle(); }
      });
    }
  }
  tools() {
    const bar = make("div", { className: "chart-tools" }, this.root);
    const button = (name, title, action) => make("button", { type: "button", textContent: say(name), title: say(title), onclick: action }, bar);
    this.player = button("Play", "Move the ship along its track", () => this.play());
    this.slider = make("input", { type: "range", min: this.from, max: this.to, step: (this.to - this.from) / 1000 || 1 }, bar);
    this.slider.setAttribute("aria-label", say("Time"));
    this.slider.addEventListener("input", (event) => { event.stopPropagation(); this.setTime(Number(this.slider.value)); });
    this.clock = make("output", {}, bar);
    button("+", "Zoom in around the cursor; or drag in a panel", () => this.zoomBy(.5)).setAttribute("aria-label", say("Zoom in"));
    button("−", "Zoom out", () => this.zoomBy(2)).setAttribute("aria-label", say("Zoom out"));
    button("Reset", "Show everything; or double-click in a panel", () => this.reset());
    if (this.root.requestFullscreen) button("Full screen", "Full screen; Escape leaves it", () => document.fullscreenElement ? document.exitFullscreen() : this.root.requestFullscreen());
    button("CSV", "Download the values of the drawn lines", () => save(this.csv(), "text/csv", this.name() + ".csv"));
    button("SVG", "Download as vector graphics", () => save(this.svg().text, "image/svg+xml", this.name() + ".svg"));
    button("PNG", "Download as an image", () => this.png());
  }
  name() { return (this.plots[0].getAttribute("aria-label") || "chart").replace(/[^\w.-]+/g, "-").toLowerCase(); }
  play() {
    if (this.playing) { clearInterval(this.playing); this.playing = null; this.player.textContent = say("Play"); return; }
    this.player.textContent = say("Pause");
    if (this.time >= this.to) this.setTime(this.from);
    const step = (this.to - this.from) / 300;
    this.playing = setInterval(() => { this.setTime(this.time + step); if (this.time >= this.to) this.play(); }, 40);
  }
  // Table of values at the cursor: a row for each line, a column for each quantity.
  table() {
    const shown = this.panels.filter((panel) => !panel.isGround);
    this.columns = shown.map((panel) => ({ quantity: panel.quantity, title: `${panel.title} [${panel.unit}]` }));
    if (this.panels.some((panel) => panel.isGround))
      this.columns.unshift({ quantity: "x", title: say("x north [m]") }, { quantity: "y", title: say("y east [m]") });
    const box = make("div", { className: "chart-values", tabIndex: 0 }, this.root), table = make("table", {}, box);
    box.setAttribute("role", "region");
    box.setAttribute("aria-label", say("Values at the cursor"));
    const head = make("tr", {}, make("thead", {}, table));
    make("th", { textContent: say("At the cursor"), scope: "col" }, head);
    for (const column of this.columns) make("th", { className: "num", textContent: column.title, scope: "col" }, head);
    this.body = make("tbody", {}, table);
    this.rows = this.classes.map((name) => {
      const row = make("tr", {}, this.body);
      make("th", { scope: "row", textContent: this.lines.find((line) => line.class === name).name }, row);
      const cells = this.columns.map(({ quantity }) => {
        const cell = make("td", { className: "num" }, row);
        cell.dataset.value = quantity;
        return cell;
      });
      row.dataset.line = name;
      return { name, row, cells };
    });
  }
  setTime(time) {
    this.time = Math.min(this.to, Math.max(this.from, time));
    this.slider.value = this.time;
    const decimals = this.to - this.from < 20 ? 2 : 1;
    this.clock.textContent = `t = ${local(this.time.toFixed(decimals))} s`;
    this.slider.setAttribute("aria-valuetext", this.clock.textContent);
    this.follow();
    for (const panel of this.panels) this.mark(panel);
    for (const { name, row, cells } of this.rows) {
      row.hidden = this.hidden.has(name);
      cells.forEach((cell, column) => {
        const quantity = this.columns[column].quantity;
        const line = this.lines.find((line) => line.class === name && line.values[quantity]);
        cell.textContent = line ? local(text(line.values[quantity], nearest(line.values.t.list, this.time))) : "";
      });
    }
  }
  // Marks of the cursor in a panel: a line at the time and a spot on each line; on the ground the ship.
  mark(panel) {
    panel.overlay.replaceChildren();
    if (!panel.isGround) {
      const [, top, , height] = panel.part;
      draw("path", { class: "cursor", d: `M${panel.x(this.time)} ${top}v${height}` }, panel.overlay);
    }
    for (const line of this.visible()) {
      const { t, x, y, psi } = line.values, index = nearest(t.list, this.time);
      const at = panel.isGround ? [y?.list[index], x?.list[index]] : [t.list[index], line.values[panel.quantity]?.list[index]];
      if (!at.every(Number.isFinite) || line.class === "band") continue;
      if (panel.isGround && this.hull && Number.isFinite(psi?.list[index])) this.ship(panel, line.class, at, psi.list[index]);
      draw("path", { class: line.class + " spot", d: `M${panel.x(at[0])} ${panel.y(at[1])}h0` }, panel.overlay);
    }
  }
  // Outline of the ship to scale, but never too small to see.
  ship(panel, name, [east, north], heading) {
    const scale = panel.width / (panel.across[1] - panel.across[0]), least = 14 * panel.part[2] / panel.width;
    const grow = Math.max(1, least / (this.hull[0] * scale)), angle = heading * Math.PI / 180;
    const corners = OUTLINE.map(([forward, right]) => {
      const [a, b] = [forward * this.hull[0] * grow, right * this.hull[1] * grow];
      return panel.x(east + a * Math.sin(angle) + b * Math.cos(angle)) + " " + panel.y(north + a * Math.cos(angle) - b * Math.sin(angle));
    });
    draw("path", { class: name + " here", d: `M${corners.join("L")}Z` }, panel.overlay);
  }
  // Time at a place: in a panel of a channel its abscissa, on the ground that of the nearest sample.
  timeAt(panel, place) {
    if (!panel.isGround) return panel.acrossAt(place.x);
    let best = Infinity, time = this.time;
    for (const line of this.visible()) {
      const { t, x, y } = line.values;
      if (!x || !y) continue;
      t.list.forEach((at, index) => {
        const apart = Math.hypot(panel.x(y.list[index]) - place.x, panel.y(x.list[index]) - place.y);
        if (apart < best) [best, time] = [apart, at];
      });
    }
    return time;
  }
  listen(plot) {
    const own = this.panels.filter((panel) => panel.plot === plot);
    const find = (event) => own.map((panel) => [panel, panel.locate(event)]).find(([, place]) => place?.inside);
    let start = null;
    plot.addEventListener("pointerdown", (event) => {
      const found = find(event);
      if (!found || event.button !== 0) return;
      this.setTime(this.timeAt(...found));
      if (event.pointerType === "touch") return;
      start = { panel: found[0], place: found[1], part: found[0].part, pans: event.shiftKey };
      plot.setPointerCapture(event.pointerId);
      event.preventDefault();
    });
    plot.addEventListener("pointermove", (event) => {
      if (start) return this.drag(start, start.panel.locate(event));
      const found = find(event);
      if (found) this.setTime(this.timeAt(...found));
    });
    plot.addEventListener("pointerup", (event) => {
      const end = start && start.panel.locate(event);
      if (start && end && !start.pans && this.isWide(start, end)) this.zoomTo(start.panel, start.place, end);
      else if (start) this.mark(start.panel);
      start = null;
    });
    plot.addEventListener("dblclick", () => this.reset());
  }
  isWide({ panel, place }, end) { return Math.abs(end.x - place.x) > .02 * panel.part[2]; }
  drag(start, place) {
    const { panel } = start;
    if (!place) return;
    if (start.pans) {
      const [left, top, width, height] = panel.part;
      return this.shift(panel, left + start.place.x - place.x, top + start.place.y - place.y, width, height);
    }
    this.mark(panel);
    const [, top, , height] = panel.part;
    const y = panel.isGround ? Math.min(place.y, start.place.y) : top;
    draw("rect", { class: "choice", x: Math.min(place.x, start.place.x), y, width: Math.abs(place.x - start.place.x),
      height: panel.isGround ? Math.abs(place.y - start.place.y) : height }, panel.overlay);
  }
  zoomTo(panel, a, b) {
    if (!panel.isGround) return this.showTimes(panel.acrossAt(Math.min(a.x, b.x)), panel.acrossAt(Math.max(a.x, b.x)));
    // Equal scales: the rectangle grows to the proportions of the panel.
    const share = Math.max(Math.abs(a.x - b.x) / panel.width, Math.abs(a.y - b.y) / panel.height);
    this.shift(panel, (a.x + b.x - share * panel.width) / 2, (a.y + b.y - share * panel.height) / 2, share * panel.width, share * panel.height);
  }
  shift(panel, left, top, width, height) {
    if (!panel.isGround) return this.showTimes(panel.acrossAt(left), panel.acrossAt(left + width));
    panel.show([left, top, width, height]);
    this.redraw(panel.plot);
  }
  // Shows a range of times in all panels of channels, each over the range of its values there.
  showTimes(from, to) {
    for (const panel of this.panels.filter((panel) => !panel.isGround)) {
      const inside = this.visible().flatMap(({ values }) => (values[panel.quantity]?.list ?? [])
        .filter((value, index) => values.t.list[index] >= from && values.t.list[index] <= to && Number.isFinite(value)));
      let [low, high] = inside.length ? [Math.min(...inside), Math.max(...inside)] : panel.up;
      const room = Math.max(.06 * (high - low), .01 * (panel.up[1] - panel.up[0]));
      [low, high] = [low - room, high + room];
      panel.show([panel.x(from), panel.y(high), panel.x(to) - panel.x(from), panel.y(low) - panel.y(high)]);
    }
    this.times = [from, to];
    for (const plot of this.plots) this.redraw(plot);
  }
  zoomBy(factor) {
    const panel = this.panels.find((panel) => panel.isGround);
    if (panel && this.lines.some((line) => line.values.x)) {
      const line = this.visible().find((line) => line.values.x), index = line ? nearest(line.values.t.list, this.time) : 0;
      const [x, y] = line ? [panel.x(line.values.y.list[index]), panel.y(line.values.x.list[index])] : [panel.width / 2, panel.height / 2];
      const share = Math.min(1, panel.part[2] / panel.width * factor), [width, height] = [share * panel.width, share * panel.height];
      this.shift(panel, share < 1 ? x - width / 2 : 0, share < 1 ? y - height / 2 : 0, width, height);
    }
    const [from, to] = this.times ?? [this.from, this.to], half = Math.min(to - from, (this.to - this.from) / factor) * factor / 2;
    const middle = Math.min(this.to - half, Math.max(this.from + half, this.time));
    this.showTimes(middle - half, middle + half);
  }
  // Keeps the cursor in the range of times that is shown.
  follow() {
    if (!this.times) return;
    const [from, to] = this.times;
    if (this.time < from) this.showTimes(this.time, this.time + to - from);
    if (this.time > to) this.showTimes(this.time - to + from, this.time);
  }
  reset() {
    this.times = null;
    for (const panel of this.panels) panel.show([0, 0, panel.width, panel.height]);
    for (const plot of this.plots) this.redraw(plot);
  }
  redraw(plot) {
    const own = this.panels.filter((panel) => panel.plot === plot);
    const whole = own.every(({ part, width, height }) => part[0] === 0 && part[1] === 0 && part[2] === width && part[3] === height);
    plot.querySelector(".live-grid")?.remove();
    for (const part of plot.querySelectorAll(":scope > .grid, :scope > .zero, :scope > .tick, :scope > .ring, :scope > .start"))
      part.style.display = whole ? "" : "none";
    if (!whole) {
      const layer = draw("g", { class: "live-grid" }, plot);
      plot.prepend(layer);
      own.forEach((panel, index) => panel.grid(layer, panel.isGround || index + 1 === own.length));
    }
    for (const panel of own) this.mark(panel);
  }
  csv() {
    const names = [...new Set(this.lines.flatMap((line) => Object.keys(line.values)))].filter((name) => name !== "t");
    const unit = (name) => this.panels.find((panel) => panel.quantity === name)?.unit ?? "m";
    const rows = [["line", "t [s]", ...names.map((name) => `${name} [${unit(name)}]`)]];
    for (const line of this.visible())
      line.values.t.list.forEach((_, index) => rows.push([JSON.stringify(line.name), text(line.values.t, index, 9), ...names.map((name) => text(line.values[name], index, 9))]));
    return rows.map((row) => row.join(",")).join("\n") + "\n";
  }
  // All plots side by side in one image, with the styles of the page.
  svg() {
    const sizes = this.plots.map((plot) => plot.viewBox.baseVal), height = Math.max(...sizes.map((size) => size.height)) + 10;
    const width = sizes.reduce((sum, size) => sum + size.width + 10, 0), paper = getComputedStyle(document.body).backgroundColor;
    let left = 0;
    const parts = this.plots.map((plot, index) => {
      const copy = plot.cloneNode(true), originals = plot.querySelectorAll("*");
      copy.querySelectorAll("*").forEach((node, place) => {
        const style = getComputedStyle(originals[place]);
        for (const name of STYLES) node.setAttribute(name, style.getPropertyValue(name));
      });
      for (const [name, value] of Object.entries({ x: left, y: 5, width: sizes[index].width, height: sizes[index].height })) copy.setAttribute(name, value);
      left += sizes[index].width + 10;
      return new XMLSerializer().serializeToString(copy);
    });
    return { width, height, text: `<svg xmlns="${this.plots[0].namespaceURI}" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}"><rect width="100%" height="100%" fill="${paper}"/>${parts.join("")}</svg>` };
  }
  async png() {
    const { text, width, height } = this.svg(), image = new Image();
    image.src = URL.createObjectURL(new Blob([text], { type: "image/svg+xml" }));
    await image.decode();
    const canvas = Object.assign(document.createElement("canvas"), { width: 2 * width, height: 2 * height });
    canvas.getContext("2d").drawImage(image, 0, 0, 2 * width, 2 * height);
    canvas.toBlob((blob) => save(blob, "image/png", this.name() + ".png"));
  }
}

const save = (content, type, name) => {
  const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(new Blob([content], { type })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
};
const start = () => {
  for (const root of document.querySelectorAll(".chart:not([data-live])")) {
    root.dataset.live = "";
    new Chart(root);
  }
};
document.addEventListener("content", start);
start();
})();
