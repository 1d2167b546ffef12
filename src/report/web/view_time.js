// Time: playing, stepping, and what shows it. Picture, clock and plots follow one time.
const showEvery = 100, // [ms]
  calmEvery = 500; // between the steps of a reader who asks for less motion [ms]

function startTime(view, bar) {
  const {state} = view,
    [run] = view.runs,
    {times} = run,
    end = times[times.length - 1];
  // What is played: all of it, or one period of one mode.
  const span = () => (state.mode > 0 ? {from: state.mode - 1, to: Math.min(end, state.mode)} : {from: times[0], to: end});
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

  view.setMode = function (mode) {
    state.mode = mode;
    view.setTime(mode > 0 ? mode - 0.75 : times[0]); // a quarter of a period: where the shape is farthest
    view.play(mode > 0);
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
    const {from, to} = span();
    if (time >= to || time < from) {
      if (!state.loop) {
        view.setTime(to);
        view.play(false);
        return;
      }
      // The last picture is seen before the first follows; a period goes on without one.
      time = state.mode > 0 ? from + Math.max(0, (time - from) % 1) : state.time >= to ? from : to;
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
    if (!state.loop && state.time >= span().to) view.setTime(span().from);
    requestAnimationFrame(tick);
  };
}
