#pragma once
/// The data of a run that the script of a view needs: one JSON object with its numbers packed.
///
///   {"name","isStatic","timeLabel","times":[t],"origin":[3],"middle":[3],"size","look","numPoints",
///    "curves":[{"name","first","points","outline","subdomains"}],"bodies":[{"name","track","axes":[4],"mesh","arms":[3
///      each]}],
///    "links":[{"name","kind","first","second","axes":[4]}],"frames":[{"name","track","axes":[4]}],"arrows":[{"name","track"}],
///    "outlines":[[[x2,x3,...] per
///      loop]],"meshes":[{"points","triangles"}],"quantities":[{"name","label","unit","low","high"}],
///    "signals":[{"name"}], their values in the array "signals", those of a signal one after another,
///    "plots":[{"title","unit","part","times":array,"columns":[{"label","values":array}]}],
///    "arrays":{name:[type,offset,count]},"packed":base64 of zlib}
///
/// A track is a moving frame: its position at the start from `origin`, its displacement in 65535ths of its own range,
/// and the rotation from the start as the vector part of a quaternion with w >= 0 in 32767ths. Equal tracks are stored
/// once, so beams that meet in a node share it. Arrays of frames (d16, d8) are differences from frame to frame.
#include <string>

#include "bough/report/page.hpp"

namespace bough::report {

/// How many signals a page lists: the first ones of the pictures, which all have the same.
std::size_t num_signals_shown(const RunFiles& run);

/// Every second frame is omitted, repeatedly, until the packed numbers are below `most_bytes`.
std::string view_data(const RunFiles& run, std::size_t most_bytes = 13'500'000);

}  // namespace bough::report
