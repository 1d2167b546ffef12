#pragma once
/// The style of pages around their drawings, light, dark and printed.
#include <string_view>

namespace bough::report {

inline constexpr std::string_view page_style = R"css(
:root{color-scheme:light dark}
body{margin:0 auto;max-width:1000px;padding:20px;font:15px/1.5 system-ui,sans-serif;background:#f4f3f0;color:#0b0b0b}
h1,h2,h3,p,li,summary,caption,figcaption{overflow-wrap:anywhere}h1{font-size:22px;margin:0 0 4px}h2{font-size:16px;margin:28px 0 8px}p{margin:4px 0}
.lead{color:#52514e}.status{font-weight:600}
figure{margin:0}svg{display:block;width:100%;height:auto;border-radius:6px}
.plots{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,340px),1fr));gap:12px}.plots figure,.charts figure{max-width:560px}
.reading{min-height:1.5em;font-size:12px;color:#52514e;font-variant-numeric:tabular-nums;overflow-wrap:anywhere}
button,select{font:inherit;padding:2px 8px}output{min-width:8em;font-variant-numeric:tabular-nums}
summary{cursor:pointer;margin:8px 0}
.stage{position:relative}.stage canvas{display:block;width:100%;touch-action:none}
.stage canvas:focus-visible{outline:2px solid #2a78d6;outline-offset:2px}
.tip{position:absolute;pointer-events:none;max-width:170px;padding:1px 7px;border-radius:4px;background:#0b0b0b;color:#fff;font-size:13px;overflow-wrap:anywhere}
.legend{position:absolute;right:10px;top:8px;font-size:12px;text-align:right;pointer-events:none;background:#fcfcfbcc;padding:0 4px;border-radius:4px}
.ramp{display:flex;width:168px}.ramp i{flex:1;height:10px}.domains i{display:inline-block;width:12px;height:10px;margin:0 3px 0 8px}.ends{display:flex;justify-content:space-between;width:168px}
.triad{position:absolute;left:6px;bottom:6px;width:60px;height:60px;pointer-events:none}.triad svg{border-radius:0}
.rule{position:absolute;left:78px;bottom:10px;font-size:12px;pointer-events:none}.rule i{display:block;height:5px;border:1.5px solid currentColor;border-top:0}
.bar{display:flex;flex-wrap:wrap;gap:6px 10px;align-items:center;margin:8px 0}.bar input[type=range]{flex:1;min-width:120px}.bar button:first-child{min-width:4.6em}
.choices{font-size:13px}.choices label{white-space:nowrap}.choices select{max-width:15em}.bar.choices button{min-width:0}
.has-view #motion{display:none}@media screen and (scripting:enabled){html:not(.no-view) #motion{display:none}}#viewer[hidden]{display:none}
.plot{border-radius:6px;padding:4px;background:#fcfcfb}.plot.lit{outline:3px solid #b3261e}.plot svg{touch-action:pan-y;cursor:crosshair}
.plot-head{display:flex;gap:6px;align-items:baseline}.plot-head button{border:0;background:none;color:inherit;padding:0 3px;font-size:12px;cursor:pointer}
.plot-name{flex:1;min-width:0;text-align:left;font-weight:600;overflow:hidden;text-overflow:ellipsis;white-space:nowrap}.plot-name:focus-visible{white-space:normal}
.plot-tools{white-space:nowrap;color:#52514e}.plot-tools button[aria-pressed=true]{text-decoration:underline;font-weight:600}
.plot .reading{display:flex;flex-wrap:wrap;gap:0 10px}.key i{display:inline-block;width:14px;border-top:3px solid;vertical-align:middle;margin-right:4px}.key i.dashed{border-top-style:dashed}
.key.s0 i{color:#2a78d6}.key.s1 i{color:#eb6834}.key.s2 i{color:#1baf7a}.key.s3 i{color:#4a3aa7}.key.s4 i{color:#e87ba4}.key.s5 i{color:#c98500}
.band{fill:#2a78d6;opacity:.15}
.signals{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,220px),1fr));gap:0 18px}
.signals p{display:flex;gap:10px;justify-content:space-between;border-bottom:1px solid #d9d8d1}.signals span{min-width:0;overflow-wrap:anywhere}.signals output{min-width:0;white-space:nowrap}.signals output+output{color:#b4501f}
table{border-collapse:collapse;font-variant-numeric:tabular-nums}td,th{padding:3px 14px 3px 0;text-align:left;border-bottom:1px solid #d9d8d1}
.wide{overflow-x:auto}ul{margin:4px 0;padding-left:20px}
.charts{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,340px),1fr));gap:12px;margin:8px 0}
h3{font-size:15px;margin:18px 0 4px}caption{text-align:left;padding:0 0 4px;color:#52514e}figcaption{font-size:13px;color:#52514e}
td.number,th.number{text-align:right}td.number{white-space:nowrap}td:first-child{min-width:9em}.good{color:#00684a}.bad{color:#b3261e}.soft-text{color:#52514e}a{color:#1c5cab}
tr.chosen td{background:#fbe3d8}th button{min-width:0;padding:0;border:0;background:none;font-weight:600;color:inherit;cursor:pointer}
#cases td{cursor:default}
@media screen and (max-width:640px){figure,#scatter{overflow-x:auto}svg[viewBox^="0 0 960"]{min-width:640px}}
@media (prefers-color-scheme:dark){.cards td::before{color:#c3c2b7!important}tr.chosen td{background:#5a2f1c}body{background:#0d0d0d;color:#fff}.lead,.reading{color:#c3c2b7}td,th,.signals p{border-color:#383835}.signals output+output{color:#eb6834}
.plot{background:#1a1a19}.plot.lit{outline-color:#f2b632}.plot-tools{color:#c3c2b7}.legend{background:#1a1a19cc}.key.s3 i{color:#9085e9}.tip{background:#fff;color:#0b0b0b}
caption,figcaption,.soft-text{color:#c3c2b7}.good{color:#5ad0a5}.bad{color:#ff8a80}a{color:#86b6ef}}
@media print{#viewer,.plot-tools,.has-view #no-webgl{display:none}.has-view #motion{display:block}.plot,.plot.lit{outline:0;background:none}
details::details-content{content-visibility:visible;height:auto;display:block}body{max-width:none;padding:0;background:#fff;font-size:12px}figure,tr{break-inside:avoid}h2,h3{break-after:avoid}.wide{overflow:visible}
.charts,.plots{grid-template-columns:minmax(0,1fr) minmax(0,1fr)}}
)css";

}  // namespace bough::report
