#pragma once
/// Where a long text goes, piece by piece, so that it need not be in memory as a whole.
#include <functional>
#include <string_view>

namespace bough::io {

using TextSink = std::function<void(std::string_view)>;
/// Writes a text into a sink.
using TextWriter = std::function<void(const TextSink&)>;

}  // namespace bough::io
