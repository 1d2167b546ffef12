// An expression that measures how far beams change their lengths between the pictures of a run, as it is drawn: for
// instants all over the run, the largest difference of the length of a beam from chord to chord, and from end to end,
// from that between the pictures beside, relative to the length; and the number of pictures.
(function () {
  "use strict";
  const [run] = boughView.runs,
    {pointTrack} = run.data,
    times = run.times;
  const lengths = function (time) {
    const {x} = posesAt(run, time, 1),
      all = [];
    const between = function (p, q) {
      const a = 3 * pointTrack[p],
        b = 3 * pointTrack[q];
      return Math.hypot(x[a] - x[b], x[a + 1] - x[b + 1], x[a + 2] - x[b + 2]);
    };
    for (const c of run.curves) {
      let along = 0;
      for (let p = c.first; p + 1 < c.first + c.points; ++p) along += between(p, p + 1);
      all.push(along, between(c.first, c.first + c.points - 1));
    }
    return all;
  };
  let worst = 0;
  for (let n = 0; n < 3000; ++n) {
    const time = times[0] + ((n + 0.37) / 3000) * (times[times.length - 1] - times[0]),
      {k, f} = placeOf(times, time),
      before = lengths(times[k]),
      after = lengths(times[k + 1]);
    lengths(time).forEach(function (length, i) {
      const low = Math.min(before[i], after[i]),
        high = Math.max(before[i], after[i]);
      worst = Math.max(worst, (low - length) / high, (length - high) / high);
    });
  }
  return [worst, times.length];
})();
