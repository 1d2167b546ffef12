// Values of signals at the time shown, in the list that the page holds of its end.
function startSignals(view) {
  const list = document.getElementById("signals"),
    line = document.getElementById("signals-at");
  view.showSignals = function () {};
  if (!list || !line) return;
  const [first] = view.runs,
    rows = Array.from(list.children).map(function (item, k) {
      const name = first.signals[k].name;
      return Array.from(item.querySelectorAll("output")).map(function (output, r) {
        const run = view.runs[r],
          at = run.signals.findIndex((s) => s.name === name),
          n = run.times.length;
        return {output: output, times: run.times, values: at < 0 ? null : run.data.signals.subarray(at * n, at * n + n)};
      });
    });
  view.showSignals = function (time) {
    line.textContent = "At " + (first.isStatic ? first.timeLabel + " " : "t = ") + number(time, 5) + (first.isStatic ? "" : " s");
    for (const row of rows)
      for (const {output, times, values} of row) {
        const value = values ? valueAt(times, values, time) : NaN;
        output.textContent = Number.isNaN(value) ? "–" : number(value, 5);
      }
  };
}
