#!/usr/bin/env node
// measure_view.js PAGE [SCREENSHOT.png]   opens a view in headless Chromium with WebGL in software, 1000 x 700, in real
// time. It prints the time from the start of the navigation to the first picture (in a browser that has drawn before),
// the pictures per second while the motion plays (lines if shapes are too slow), the processor time of each, and the
// time of the shapes afterwards. It needs node, but no packages.
"use strict";
const {spawn} = require("child_process"),
  fs = require("fs"),
  os = require("os"),
  path = require("path");

const profile = fs.mkdtempSync(path.join(os.tmpdir(), "view-"));
const browser = spawn(
  "chromium",
  [
    "--headless",
    "--no-sandbox",
    "--disable-dev-shm-usage",
    "--no-first-run",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--proxy-server=127.0.0.1:9",
    "--window-size=1000,700",
    "--disable-background-timer-throttling",
    "--disable-renderer-backgrounding",
    "--disable-backgrounding-occluded-windows",
    "--remote-debugging-pipe",
    "about:blank",
    "--user-data-dir=" + profile,
  ],
  {stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"]},
);
let next = 1,
  rest = "",
  session;
const waiting = new Map();
browser.stdio[4].on("data", function (data) {
  const parts = (rest + data).split("\0");
  rest = parts.pop();
  for (const text of parts) {
    const message = JSON.parse(text),
      done = waiting.get(message.id);
    if (!done) continue;
    waiting.delete(message.id);
    done(message);
  }
});
function send(method, params) {
  const id = next++;
  browser.stdio[3].write(JSON.stringify({id: id, method: method, params: params || {}, sessionId: session}) + "\0");
  return new Promise(function (resolve, reject) {
    waiting.set(id, function (m) {
      m.error ? reject(new Error(method + ": " + m.error.message)) : resolve(m.result);
    });
  });
}
async function evaluate(text) {
  const r = await send("Runtime.evaluate", {expression: text, awaitPromise: true, returnByValue: true});
  if (r.exceptionDetails) throw new Error(JSON.stringify(r.exceptionDetails).slice(0, 600));
  return r.result.value;
}

// Milliseconds that the browser and all processes below it have used.
function processorTime() {
  const parent = new Map(),
    used = new Map();
  for (const name of fs.readdirSync("/proc")) {
    if (!/^\d+$/.test(name)) continue;
    try {
      const text = fs.readFileSync(`/proc/${name}/stat`, "latin1"),
        field = text.slice(text.lastIndexOf(")") + 2).split(" ");
      parent.set(name, field[1]);
      used.set(name, 10 * (Number(field[11]) + Number(field[12])));
    } catch (error) {
      continue; // ended meanwhile
    }
  }
  let sum = 0;
  for (const [name, time] of used) {
    let p = name;
    while (p !== undefined && p !== String(browser.pid)) p = parent.get(p);
    if (p !== undefined) sum += time;
  }
  return sum;
}

(async function () {
  let page;
  while (!page)
    page = (await send("Target.getTargets")).targetInfos.find(function (t) {
      return t.type === "page";
    });
  const {targetId} = page;
  session = (await send("Target.attachToTarget", {targetId: targetId, flatten: true})).sessionId;
  await send("Page.enable");
  const warm = path.join(profile, "warm.html");
  fs.writeFileSync(warm, "<!DOCTYPE html><title>warm</title>");
  await send("Page.navigate", {url: "file://" + warm});
  const hasContext =
    "new Promise(function (done) { (function look() { document.title === 'warm' ? done(document.createElement('canvas').getContext('webgl2') !== null) : setTimeout(look, 5); })(); })";
  if (!(await evaluate(hasContext))) throw new Error("this browser shows no WebGL");
  await send("Page.navigate", {url: "file://" + path.resolve(process.argv[2])});
  const first = await evaluate(
    "new Promise(function (done) { (function look() { window.boughView && window.boughView.drawn ? done(performance.now()) : setTimeout(look, 5); })(); })",
  );
  await evaluate("new Promise(function (done) { setTimeout(done, 1500); })");
  const before = processorTime();
  const moving = await evaluate(`new Promise(function (done) {
    const view = window.boughView, begin = performance.now(), from = view.drawn, t = view.runs[0].times;
    (function step() {
      const now = performance.now() - begin;
      if (now > 4000) return done((view.drawn - from) / 4);
      view.setTime(t[0] + (t[t.length - 1] - t[0]) * ((now / 2000) % 1));
      requestAnimationFrame(step);
    })();
  })`);
  const used = processorTime() - before;
  const after = await evaluate(`new Promise(function (done) {
    const view = window.boughView, begin = performance.now();
    delete view.shapesTook;
    (function look() { view.shapesTook ? done(performance.now() - begin) : performance.now() - begin > 20000 ? done(NaN) : setTimeout(look, 5); })();
  })`);
  if (process.argv[3])
    fs.writeFileSync(process.argv[3], Buffer.from((await send("Page.captureScreenshot")).data, "base64"));
  console.log(
    `${fs.statSync(process.argv[2]).size} bytes, first picture after ${(first / 1000).toFixed(2)} s, ${moving.toFixed(0)} pictures a second while it moves, ${(used / (4 * moving)).toFixed(0)} ms of processors each, shapes ${(after / 1000).toFixed(2)} s after`,
  );
})()
  .catch(function (error) {
    console.error(error.message);
    process.exitCode = 1;
  })
  .finally(function () {
    browser.once("exit", function () {
      fs.rmSync(profile, {recursive: true, force: true, maxRetries: 5});
    });
    browser.kill();
  });
