#include "bough/scene/components.hpp"

namespace bough::scene {

const std::vector<std::string>& decision_names() {
  static const std::vector<std::string> names{"welded",    "line",  "translation", "planar", "held",
                                              "symmetric", "reuse", "lanes",       "small"};
  return names;
}

const std::vector<std::string>& retired_decision_names() {
  static const std::vector<std::string> names{"driven", "definite"};
  return names;
}

std::vector<std::string> names_in_without() {
  std::vector<std::string> names = decision_names();
  names.insert(names.end(), retired_decision_names().begin(), retired_decision_names().end());
  return names;
}

std::string to_string(FigureKind kind) { return to_string(static_cast<MeasureKind>(kind)); }

const std::vector<std::string>& solver_form_names() {
  static const std::vector<std::string> names{"local", "augmented", "global", "hybrid", "monolithic"};
  return names;
}

std::string to_string(SolverForm form) { return solver_form_names()[static_cast<std::size_t>(form)]; }

std::string to_string(MeasureKind kind) {
  static const char* const names[] = {
      "value", "max", "min",        "time_of_max",   "time_of_min",        "range",  "period",
      "mean",  "rms", "percentile", "settling_time", "dominant_frequency", "cycles", "equivalent_range"};
  return names[static_cast<int>(kind)];
}

}  // namespace bough::scene
