#pragma once
/// Tables of batches as texts.
#include <string>

#include "bough/study/batch.hpp"

namespace bough::support {

inline std::string text_of(const io::TextWriter& writer) {
  std::string text;
  writer([&text](std::string_view part) { text += part; });
  return text;
}

inline std::string batch_csv(const study::CaseTable& results) {
  return text_of([&](const io::TextSink& sink) { study::write_batch_csv(results, sink); });
}
inline std::string batch_json(const study::CaseTable& results, const std::string& title) {
  return text_of([&](const io::TextSink& sink) { study::write_batch_json(results, title, {}, sink); });
}
inline std::string cost_csv(const study::CaseTable& results) {
  return text_of([&](const io::TextSink& sink) { study::write_cost_csv(results, sink); });
}

}  // namespace bough::support
