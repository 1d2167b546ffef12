// Time: playing, stepping, and what shows it. Picture, clock and plots follow one time.
const showEvery = 100, // [ms]
  calmEvery = 500; // between the steps of a reader who asks for less motion [ms]

function startTime(view, bar) {
  const {state} = view,
    [run] = view.runs,
    {times} = run,
    end = times[times.length - 1];
  // The page around the picture takes longer to be painted than the lines in it: while time goes on it follows ten times
  // a second, and at rest at once.
  let shownAt = -Infinity,
    timer = 0;
  const show = function () {
    timer = 0;
    shownAt = performance.now();
    bar.showTime(state.time);
    for (const p of view.plots) p.show(state.time);
    view.showSignals(state.time);
  };
  view.setTime = function (time) {
    state.time = Math.min(end, Math.max(times[0], time));
    state.moving = performance.now();
    if (state.moving - shownAt >= showEvery) {
      clearTimeout(timer);
      show();
    } else if (!timer) timer = setTimeout(show, showEvery);
    view.request();
  };
  view.stepPicture = function (n) {
    view.play(false);
    view.setTime(times[Math.min(times.length - 1, Math.max(0, rowAt(times, state.time) + n))]);
  };
  view.stepRow = function (n) {
    view.play(false);
    const rows = run.plots.length ? run.data[run.plots[0].times] : times;
    view.setTime(rows[Math.min(rows.length - 1, Math.max(0, rowAt(rows, state.time) + n))]);
  };

  let lastStamp = 0;
  function tick(stamp) {
    if (!state.playing) return;
    const isCalm = view.calm.matches;
    if (isCalm && lastStamp && stamp - lastStamp < calmEvery) {
      requestAnimationFrame(tick);
      return;
    }
    const most = isCalm ? 2 * calmEvery : 250; // of a page that was hidden, time does not run on
    let time = state.time + (lastStamp ? (Math.min(most, stamp - lastStamp) / 1000) * state.speed : 0);
    lastStamp = stamp;
    if (time >= end) {
      if (!state.loop) {
        view.setTime(end);
        view.play(false);
        return;
      }
      time = state.time >= end ? times[0] : end; // the last picture is seen before the first follows
    }
    view.setTime(time);
    requestAnimationFrame(tick);
  }
  view.play = function (on) {
    if (on === state.playing) return;
    state.playing = on;
    bar.showPlaying(on);
    lastStamp = 0;
    if (!on) return view.request();
    if (!state.loop && state.time >= end) view.setTime(times[0]);
    requestAnimationFrame(tick);
  };
}
