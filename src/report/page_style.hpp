#pragma once
/// The style of pages around their drawings, light, dark and printed.
#include <string_view>

namespace bough::report {

inline constexpr std::string_view page_style = R"css(
:root{color-scheme:light dark}
body{margin:0 auto;max-width:1000px;padding:20px;font:15px/1.5 system-ui,sans-serif;background:#f4f3f0;color:#0b0b0b}
h1{font-size:22px;margin:0 0 4px}h2{font-size:16px;margin:28px 0 8px}p{margin:4px 0}
.lead{color:#52514e}.status{font-weight:600}
figure{margin:0}svg{display:block;width:100%;height:auto;border-radius:6px}
.plots{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,420px),1fr));gap:12px}
.reading{min-height:1.5em;font-size:12px;color:#52514e;font-variant-numeric:tabular-nums;overflow-wrap:anywhere}
#player{display:flex;gap:12px;align-items:center;margin:8px 0}#player[hidden]{display:none}#player input{flex:1}
button{font:inherit;min-width:5em;padding:2px 10px}output{min-width:8em;font-variant-numeric:tabular-nums}
table{border-collapse:collapse;font-variant-numeric:tabular-nums}td,th{padding:3px 14px 3px 0;text-align:left;border-bottom:1px solid #d9d8d1}
.wide{overflow-x:auto}ul{margin:4px 0;padding-left:20px}
.charts{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,420px),1fr));gap:12px;margin:8px 0}
h3{font-size:15px;margin:18px 0 4px}caption{text-align:left;padding:0 0 4px;color:#52514e}figcaption{font-size:13px;color:#52514e}
td.number,th.number{text-align:right}td.number{white-space:nowrap}td:first-child{min-width:9em}.good{color:#00684a}.bad{color:#b3261e}.soft-text{color:#52514e}a{color:#1c5cab}
tr.chosen td{background:#fbe3d8}th button{min-width:0;padding:0;border:0;background:none;font-weight:600;color:inherit;cursor:pointer}
#cases td{cursor:default;max-width:28em;overflow-wrap:anywhere}
@media (prefers-color-scheme:dark){tr.chosen td{background:#5a2f1c}body{background:#0d0d0d;color:#fff}.lead,.reading{color:#c3c2b7}td,th{border-color:#383835}
caption,figcaption,.soft-text{color:#c3c2b7}.good{color:#5ad0a5}.bad{color:#ff8a80}a{color:#86b6ef}}
@media print{body{max-width:none;padding:0;background:#fff;font-size:12px}figure,tr{break-inside:avoid}h2,h3{break-after:avoid}.wide{overflow:visible}
.charts,.plots{grid-template-columns:1fr 1fr}}
)css";

}  // namespace bough::report
