// The plots of one run, or of two and their differences.
function startPlots(view) {
  const place = document.getElementById("plots"),
    {runs} = view,
    [a, b] = runs;
  view.plots = [];
  if (!place || !a.plots.length) return;
  place.replaceChildren();
  const seriesOf = function (run, plot, dashed, mark) {
    const times = run.data[plot.times];
    return plot.columns.map(function (c, k) {
      const around = run.data[c.values], // in single precision from a number of double precision, where that is given
        values = c.from ? Float64Array.from(around, (v) => c.from + v) : around;
      const errors = c.errors && run.data[c.errors]; // how far values may be off
      return {label: c.label + mark, times, values, errors, dashed, color: k % 6, digits: c.from ? 15 : 8};
    });
  };
  const onTime = function (time, isHover) {
    if (view.setTime && !isHover) view.setTime(time);
    else for (const p of view.plots) p.show(time);
  };
  a.plots.forEach(function (plot) {
    const other =
      b &&
      b.plots.find(function (p) {
        // Forces and moments of one sensor have one title.
        const same = p.title === plot.title && p.unit === plot.unit && p.columns.length === plot.columns.length;
        return same && p.columns.every((c, k) => c.label === plot.columns[k].label);
      });
    const series = seriesOf(a, plot, false, b ? " A" : "").concat(other ? seriesOf(b, other, true, " B") : []);
    const roundOff = Math.max(plot.roundOff, other ? other.roundOff : 0);
    const own = new Plot(place, plot.title, plot.unit, a.timeLabel, series, roundOff, onTime);
    own.part = plot.part;
    view.plots.push(own);
    if (!other) return;
    const times = a.data[plot.times];
    const difference = plot.columns.map(function (c, k) {
      const theirs = series[plot.columns.length + k].values,
        t2 = b.data[other.times],
        mine = series[k].values;
      return {
        label: c.label + " A - B",
        times: times,
        color: k % 6,
        digits: 8,
        values: mine.map(function (v, r) {
          return v - valueAt(t2, theirs, times[r]);
        }),
      };
    });
    const gap = new Plot(place, plot.title + ", difference", plot.unit, a.timeLabel, difference, roundOff, onTime);
    gap.part = plot.part;
    view.plots.push(gap);
  });
  for (const p of view.plots)
    p.name.addEventListener("click", function () {
      if (view.select) view.select(p.part);
    });
}
