#include "bough/scene/analysis_kinds.hpp"

namespace bough::scene {

const std::vector<AnalysisType>& analysis_types() {
  static const std::vector<AnalysisType> types = {
      {AnalysisKind::statics, "static", "statics", false, false},
      {AnalysisKind::dynamics, "dynamic", "dynamics", true, true},
      {AnalysisKind::inverse_dynamics, "inverse_dynamics", "inverse dynamics", true, false},
      {AnalysisKind::modes, "modes", "modes", true, false, true, true},
      {AnalysisKind::response, "response", "a frequency response", true, false, true, true},
      {AnalysisKind::linear_model, "linear_model", "a linear model", true, false, true, true},
      {AnalysisKind::buckling, "buckling", "buckling", false, false, true, true},
      {AnalysisKind::campbell, "campbell", "a Campbell diagram", true, false, true, true},
  };
  return types;
}

const AnalysisType& type_of(AnalysisKind kind) { return analysis_types().at(static_cast<std::size_t>(kind)); }

std::optional<AnalysisKind> analysis_kind_named(std::string_view name) {
  for (const AnalysisType& type : analysis_types())
    if (type.name == name) return type.kind;
  return std::nullopt;
}

}  // namespace bough::scene
