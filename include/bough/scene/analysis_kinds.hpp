#pragma once
/// The kinds of analyses as a table. What a kind is in files, checks, plan and options follows from its entry; the
/// keys that it takes in files stand in a table of `io` (schema_analysis.cpp), and what it does in the table of analyses
/// of `run`.
#include <optional>
#include <string_view>
#include <vector>

#include "bough/scene/scene.hpp"

namespace bough::scene {

struct AnalysisType {
  AnalysisKind kind;
  std::string_view name;   ///< in files
  std::string_view title;  ///< in sentences
  bool is_in_time;         ///< parts have velocities and accelerations, laws are functions of time; else of the load
  bool integrates;         ///< the motion follows from equations of motion, step by step
  bool is_of_instant = false;  ///< looks at one state: there is no end and no step
  /// Decisions of the plan that rest on symmetry would hide results: motions are left out only where constraints leave
  /// them out.
  bool wants_all_motions = false;
};

/// All kinds, in the order of their numbers.
const std::vector<AnalysisType>& analysis_types();
const AnalysisType& type_of(AnalysisKind kind);
std::optional<AnalysisKind> analysis_kind_named(std::string_view name);

}  // namespace bough::scene
