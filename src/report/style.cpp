#include "bough/report/picture.hpp"

namespace bough::report {

// Plain rules without variables, since drawings are also read by programs that support little CSS. t0 to t8 are one hue
// in nine steps, from faint to strong against the background; s0 to s5 distinguish curves.
std::string_view style_text() {
  return R"(
.paper{fill:#fcfcfb}
.ink{fill:#0b0b0b}.soft{fill:#52514e}
.tiny{font:12px system-ui,sans-serif}.head{font:600 13px system-ui,sans-serif}
.grid{stroke:#e1e0d9;stroke-width:1}.axis{stroke:#a9a8a0;stroke-width:1}.mark{stroke:#52514e;stroke-width:1.5;fill:none}
.beams,.bodies,.springs,.joints,.curve{fill:none;stroke-linecap:round;stroke-linejoin:round}
.beams{stroke-width:2}.bodies{stroke-width:5;stroke-opacity:.55}.springs{stroke-width:1.5;stroke-dasharray:4 4}.joints{stroke-width:6}.curve{stroke-width:1.7}
.bound{fill:none;stroke-width:.7;stroke-opacity:.7}
.t0{stroke:#9ec5f4}.t1{stroke:#86b6ef}.t2{stroke:#6da7ec}.t3{stroke:#5598e7}.t4{stroke:#3987e5}
.t5{stroke:#2a78d6}.t6{stroke:#1c5cab}.t7{stroke:#184f95}.t8{stroke:#0d366b}
.s0{stroke:#2a78d6}.s1{stroke:#eb6834}.s2{stroke:#1baf7a}.s3{stroke:#4a3aa7}.s4{stroke:#e87ba4}.s5{stroke:#c98500}
.point{stroke-width:1.5}.hollow{fill:none}.fail{stroke:#d03b3b;stroke-width:2;fill:none}.guide{stroke:#898781;stroke-width:1.2;stroke-dasharray:5 4;fill:none}
.s0.solid{fill:#2a78d6}.s1.solid{fill:#eb6834}.s2.solid{fill:#1baf7a}.s3.solid{fill:#4a3aa7}.s4.solid{fill:#e87ba4}.s5.solid{fill:#c98500}
.d1{stroke-dasharray:7 3}.d2{stroke-dasharray:2 3}
.now{stroke:#eb6834}.cursor{stroke:#eb6834;stroke-width:1}
@media (prefers-color-scheme:dark){
.paper{fill:#1a1a19}
.ink{fill:#ffffff}.soft{fill:#c3c2b7}
.grid{stroke:#2c2c2a}.axis{stroke:#6b6a64}.mark{stroke:#c3c2b7}
.t0{stroke:#184f95}.t1{stroke:#1c5cab}.t2{stroke:#256abf}.t3{stroke:#2a78d6}.t4{stroke:#3987e5}
.t5{stroke:#5598e7}.t6{stroke:#6da7ec}.t7{stroke:#9ec5f4}.t8{stroke:#cde2fb}
.s0{stroke:#3987e5}.s1{stroke:#d95926}.s2{stroke:#199e70}.s3{stroke:#9085e9}.s4{stroke:#d55181}.s5{stroke:#c98500}
.fail{stroke:#ff6f6f}
.s0.solid{fill:#3987e5}.s1.solid{fill:#d95926}.s2.solid{fill:#199e70}.s3.solid{fill:#9085e9}.s4.solid{fill:#d55181}.s5.solid{fill:#c98500}
.now{stroke:#f08a5d}.cursor{stroke:#f08a5d}
}
)";
}

}  // namespace bough::report
