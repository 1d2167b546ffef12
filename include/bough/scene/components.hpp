#pragma once
/// Names in files, of decisions and figures.
#include <string>
#include <vector>

#include "bough/scene/sensor_kinds.hpp"

namespace bough::scene {

/// Names of the decisions of the plan (plan::Decision) that Scene::without can bar.
const std::vector<std::string>& decision_names();
/// Names of decisions that no longer exist. A scene may still bar them; it gets a note and nothing else follows.
const std::vector<std::string>& retired_decision_names();
/// All names accepted in Scene::without: both lists above.
std::vector<std::string> names_in_without();

/// Names as in files.
std::string to_string(FigureKind kind);
std::string to_string(MeasureKind kind);
std::string to_string(SolverForm form);
/// Names of all forms, in the order of SolverForm.
const std::vector<std::string>& solver_form_names();

/// The figures that FigureKind and MeasureKind have in common come first in both enumerations, in the same order.
static_assert(static_cast<int>(MeasureKind::period) == static_cast<int>(FigureKind::period));

}  // namespace bough::scene
