// Histories of the sensors: SVG drawn anew where the window, the zoom or the scale changes; a cursor that goes with the picture.
function roundTicks(low, high, wanted) {
  const raw = (high - low) / wanted,
    power = Math.pow(10, Math.floor(Math.log10(raw)));
  const step =
    [1, 2, 5, 10]
      .map(function (f) {
        return f * power;
      })
      .find(function (s) {
        return s >= raw;
      }) || 10 * power;
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step && ticks.length < 20; ++k)
    ticks.push(k * step);
  return ticks;
}
function rowAt(times, time) {
  const {k, f} = placeOf(times, time);
  return Math.min(times.length - 1, f >= 0.5 ? k + 1 : k);
}
function valueAt(times, values, time) {
  if (time < times[0] || time > times[times.length - 1]) return NaN;
  const {k, f} = placeOf(times, time);
  return times.length < 2 ? values[0] : values[k] + f * (values[k + 1] - values[k]);
}

// A round number that is taken from labels: where values differ by so little that their labels would be long, or alike.
function baseOf([low, high]) {
  if (high - low >= 1e-3 * Math.max(Math.abs(low), Math.abs(high))) return 0;
  const step = Math.pow(10, Math.ceil(Math.log10(high - low)));
  return Number((step * Math.round((low + high) / 2 / step)).toPrecision(12));
}

class Plot {
  // series: [{label, times, values, dashed}], one unit; xLabel with its unit; roundOff: values below it are zero
  constructor(parent, title, unit, xLabel, series, roundOff, onTime) {
    Object.assign(this, {title, unit, xLabel, series, roundOff, onTime, log: false, own: false});
    this.element = make(parent, "figure", {class: "plot"});
    const head = make(this.element, "div", {class: "plot-head"});
    this.name = make(
      head,
      "button",
      {type: "button", class: "plot-name", title: "select the part that this sensor looks at"},
      withUnit(title, unit),
    );
    const tools = make(head, "span", {class: "plot-tools"});
    this.logButton = make(
      tools,
      "button",
      {type: "button", "aria-pressed": "false", title: "logarithmic scale of magnitudes"},
      "log",
    );
    this.ownButton =
      series.length > 1
        ? make(
            tools,
            "button",
            {type: "button", "aria-pressed": "false", title: "each component in a scale of its own"},
            "own scales",
          )
        : null;
    this.allButton = make(tools, "button", {type: "button", title: "the whole run (double click)"}, "all");
    const csv = make(tools, "button", {type: "button", title: "what is shown as CSV"}, "CSV");
    this.holder = make(this.element, "div");
    this.reading = make(this.element, "div", {class: "reading"});
    const times = series[0].times;
    this.full = [
      times[0],
      Math.max.apply(
        null,
        series.map(function (s) {
          return s.times[s.times.length - 1];
        }),
      ),
    ];
    this.range = this.full.slice();
    this.logButton.addEventListener("click", () => {
      this.log = !this.log;
      this.logButton.setAttribute("aria-pressed", this.log);
      this.draw();
    });
    if (this.ownButton)
      this.ownButton.addEventListener("click", () => {
        this.own = !this.own;
        this.ownButton.setAttribute("aria-pressed", this.own);
        this.draw();
      });
    this.allButton.addEventListener("click", () => {
      this.range = this.full.slice();
      this.draw();
    });
    csv.addEventListener("click", () => save(new Blob([this.csv()], {type: "text/csv"}), fileName(title) + ".csv"));
    this.listen();
    // Curves so far apart that none would show its course begin in scales of their own.
    const ranges = series.map((s) => {
      const r = this.scaleOf([s]);
      return s.values.every((v) => v === s.values[0]) ? 0 : r[1] - r[0];
    });
    const all = this.scaleOf(series),
      largest = Math.max.apply(null, ranges);
    if (
      this.ownButton &&
      largest > 1e-9 * Math.max(Math.abs(all[0]), Math.abs(all[1])) &&
      all[1] - all[0] > 20 * largest
    )
      this.ownButton.click();
    this.draw();
  }
  xOf(time) {
    return this.left + ((this.right - this.left) * (time - this.range[0])) / (this.range[1] - this.range[0] || 1);
  }
  timeOf(x) {
    return (
      this.range[0] +
      (this.range[1] - this.range[0]) * Math.min(1, Math.max(0, (x - this.left) / (this.right - this.left)))
    );
  }
  shownRows(s) {
    const first = Math.max(0, placeOf(s.times, this.range[0]).k),
      last = Math.min(s.times.length - 1, placeOf(s.times, this.range[1]).k + 1);
    return [first, last];
  }
  // The value as it is plotted; NaN where a logarithmic scale has no place for it.
  plotted(v) {
    if (!this.log) return v;
    return Math.abs(v) > this.roundOff ? Math.log10(Math.abs(v)) : NaN;
  }
  // Whether curves hold nothing but round-off, and something of that.
  isRoundOff(list) {
    const most = list.reduce((m, s) => s.values.reduce((n, v) => Math.max(n, Math.abs(v) || 0), m), 0);
    return most > 0 && most <= this.roundOff;
  }
  scaleOf(list) {
    let low = Infinity,
      high = -Infinity;
    for (const s of list) {
      const [first, last] = this.shownRows(s);
      for (let k = first; k <= last; ++k) {
        const v = this.plotted(s.values[k]);
        if (Number.isFinite(v)) {
          low = Math.min(low, v);
          high = Math.max(high, v);
        }
      }
    }
    if (low > high) {
      low = 0;
      high = 1;
    }
    if (this.log) low = Math.max(low, high - 12);
    else if (this.isRoundOff(list)) return [-100 * this.roundOff, 100 * this.roundOff]; // on the line of zero
    const least = 1e-12 * Math.max(Math.abs(low), Math.abs(high));
    if (high - low <= least) {
      const pad = Math.abs(high) * 0.1 || 1;
      low -= pad;
      high += pad;
    }
    return [low, high];
  }
  draw() {
    const width = 420,
      height = 200;
    this.left = 66;
    this.right = width - 14;
    this.top = 14;
    this.bottom = height - 38;
    const box = svg(null, "svg", {
      viewBox: "0 0 " + width + " " + height,
      role: "img",
      "aria-label": "history of " + this.title,
    });
    svg(box, "rect", {class: "paper", width: width, height: height});
    const shared = this.own ? null : this.scaleOf(this.series),
      first = shared || this.scaleOf([this.series[0]]);
    const yOf = (v, scale) => this.bottom - ((this.bottom - this.top) * (v - scale[0])) / (scale[1] - scale[0]);
    const isZero = this.isRoundOff(shared ? this.series : [this.series[0]]);
    const base = this.log ? 0 : baseOf(first);
    for (const t of isZero ? (this.log ? [] : [0]) : roundTicks(first[0] - base, first[1] - base, 4)) {
      const y = yOf(base + t, first);
      if (y < this.top - 1 || y > this.bottom + 1) continue;
      svg(box, "line", {class: "grid", x1: this.left, x2: this.right, y1: y, y2: y});
      svg(
        box,
        "text",
        {class: "tiny soft", x: this.left - 6, y: y + 4, "text-anchor": "end"},
        this.log ? "1e" + number(t, 4) : number(t, 6),
      );
    }
    if (this.isRoundOff(this.series))
      svg(box, "text", {class: "tiny soft", x: this.left + 8, y: this.top + 14}, "zero to round-off");
    const ticks = roundTicks(this.range[0], this.range[1], 4);
    for (const t of ticks) {
      const x = this.xOf(t);
      svg(box, "line", {class: "grid", x1: x, x2: x, y1: this.top, y2: this.bottom});
      svg(
        box,
        "text",
        {class: "tiny soft", x: x, y: this.bottom + 16, "text-anchor": x > this.right - 12 ? "end" : "middle"},
        number(t, 6),
      );
    }
    svg(box, "text", {class: "tiny soft", x: this.right, y: height - 5, "text-anchor": "end"}, this.xLabel);
    svg(
      box,
      "text",
      {class: "tiny soft", x: 6, y: height - 5},
      (this.own ? "scale of " + this.series[0].label : this.unit ? "in " + this.unit : "no unit") +
        (base > 0 ? ", minus " : base < 0 ? ", plus " : "") +
        (base ? number(Math.abs(base), 8) : ""),
    );
    svg(box, "line", {class: "axis", x1: this.left, x2: this.right, y1: this.bottom, y2: this.bottom});
    this.series.forEach((s, k) => {
      const scale = shared || this.scaleOf([s]);
      if (s.errors)
        for (const side of [-1, 1])
          svg(box, "path", {
            class: "bound s" + (s.color === undefined ? k % 6 : s.color),
            d: this.pathOf({times: s.times, values: s.values.map((v, r) => v + side * s.errors[r])}, scale, yOf),
          });
      svg(box, "path", {
        class: "curve s" + (s.color === undefined ? k % 6 : s.color) + (s.dashed ? " d1" : ""),
        d: this.pathOf(s, scale, yOf),
      });
    });
    this.cursor = svg(box, "line", {class: "cursor", y1: this.top, y2: this.bottom, visibility: "hidden"});
    this.band = svg(box, "rect", {class: "band", y: this.top, height: this.bottom - this.top, visibility: "hidden"});
    this.holder.replaceChildren(box);
    this.box = box;
    if (this.time !== undefined) this.show(this.time);
    else this.read(this.range[1]);
  }
  // Per column of pixels the smallest and the largest value: no peak is lost.
  pathOf(s, scale, yOf) {
    const [first, last] = this.shownRows(s);
    let path = "",
      pen = false,
      column = -1,
      low = 0,
      high = 0,
      end = 0;
    const put = (x, y) => {
      path += (pen ? "L" : "M") + x.toFixed(1) + " " + y.toFixed(1);
      pen = true;
    };
    const flush = () => {
      if (column < 0) return;
      if (high - low < 0.3) put(column, end);
      else {
        put(column, low);
        put(column, high);
        put(column, end);
      }
      column = -1;
    };
    for (let k = first; k <= last; ++k) {
      const v = this.plotted(s.values[k]);
      if (!Number.isFinite(v)) {
        flush();
        pen = false;
        continue;
      }
      const x = Math.round(2 * Math.min(this.right, Math.max(this.left, this.xOf(s.times[k])))) / 2;
      const y = Math.min(this.bottom, Math.max(this.top, yOf(v, scale)));
      if (x !== column) {
        flush();
        column = x;
        low = high = y;
      }
      low = Math.min(low, y);
      high = Math.max(high, y);
      end = y;
    }
    flush();
    return path;
  }
  show(time) {
    this.time = time;
    const inside = time >= this.range[0] && time <= this.range[1],
      x = this.xOf(time);
    this.cursor.setAttribute("visibility", inside ? "visible" : "hidden");
    this.cursor.setAttribute("x1", x);
    this.cursor.setAttribute("x2", x);
    this.read(time);
  }
  read(time) {
    this.reading.replaceChildren();
    make(this.reading, "span", {}, number(time, 6) + (this.xLabel.includes("[s]") ? " s" : "") + ": ");
    this.series.forEach((s, k) => {
      const item = make(this.reading, "span", {class: "key s" + (s.color === undefined ? k % 6 : s.color)});
      make(item, "i", {class: s.dashed ? "dashed" : ""});
      const off = s.errors ? valueAt(s.times, s.errors, time) : NaN;
      item.append((s.label ? s.label + " " : "") + number(valueAt(s.times, s.values, time), off < Infinity ? 7 : 5));
      if (off < Infinity) item.append(" ± " + number(off, 2));
    });
    if (this.unit) make(this.reading, "span", {}, this.unit);
  }
  listen() {
    let from = null;
    const xAt = (event) => {
      const b = this.box.getBoundingClientRect();
      return ((event.clientX - b.left) * 420) / b.width;
    };
    this.holder.addEventListener("pointerdown", (event) => {
      from = xAt(event);
      this.holder.setPointerCapture(event.pointerId);
    });
    this.holder.addEventListener("pointermove", (event) => {
      const x = xAt(event);
      if (from === null) {
        if (event.pointerType === "mouse") this.onTime(this.timeOf(x), true);
        return;
      }
      if (Math.abs(x - from) < 4) return;
      const a = Math.min(Math.max(this.left, Math.min(x, from)), this.right),
        b = Math.max(Math.min(this.right, Math.max(x, from)), this.left);
      this.band.setAttribute("x", a);
      this.band.setAttribute("width", b - a);
      this.band.setAttribute("visibility", "visible");
    });
    this.holder.addEventListener("pointerup", (event) => {
      const x = xAt(event);
      if (from !== null && Math.abs(x - from) >= 4) {
        this.zoom(this.timeOf(Math.min(x, from)), this.timeOf(Math.max(x, from)));
      } else this.onTime(this.timeOf(x), false);
      from = null;
    });
    this.holder.addEventListener("dblclick", () => {
      this.range = this.full.slice();
      this.draw();
    });
  }
  zoom(begin, end) {
    if (end > begin) this.range = [begin, end];
    this.draw();
  }
  csv() {
    const field = function (text) {
      return /[",\n]/.test(text) ? '"' + text.replace(/"/g, '""') + '"' : text;
    };
    const names = this.series.map((s) => field(withUnit(this.title + (s.label ? " " + s.label : ""), this.unit)));
    const [first, last] = this.shownRows(this.series[0]),
      lines = [field(this.xLabel) + "," + names.join(",")];
    for (let k = first; k <= last; ++k) {
      const t = this.series[0].times[k];
      if (t < this.range[0] || t > this.range[1]) continue;
      lines.push(
        t +
          "," +
          this.series
            .map(function (s) {
              return number(s.times === this.series[0].times ? s.values[k] : valueAt(s.times, s.values, t), s.digits);
            }, this)
            .join(","),
      );
    }
    return lines.join("\n") + "\n";
  }
}
