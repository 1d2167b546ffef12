#include "effective_options.hpp"

#include <charconv>

#include "bough/scene/analysis_kinds.hpp"
#include "bough/scene/components.hpp"

namespace bough::run {

namespace {

std::string number(double x) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, x).ptr;
  return {text, end};
}

/// A JSON string; names hold no control characters.
std::string quoted(const std::string& text) {
  std::string r = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') r += '\\';
    r += c;
  }
  return r + '"';
}

}  // namespace

records::EffectiveOptions effective_options(const scene::Scene& scene, const step::StepOptions& o) {
  records::EffectiveOptions list;
  const scene::AnalysisType& kind = scene::type_of(scene.analysis.kind);
  list.emplace_back("analysis/kind", quoted(std::string(kind.name)));
  if (!scene.analysis.frame.empty()) list.emplace_back("analysis/frame", quoted(scene.analysis.frame));
  if (kind.is_of_instant && kind.is_in_time) {
    list.emplace_back("analysis/about",
                      quoted(scene.analysis.start == scene::StartKind::equilibrium ? "equilibrium" : "start"));
    const bool is_over_parameter = scene.analysis.kind == scene::AnalysisKind::campbell;
    if (is_over_parameter) list.emplace_back("analysis/parameter", quoted(scene.analysis.campbell.parameter));
    if (is_over_parameter || scene.analysis.kind == scene::AnalysisKind::modes) {
      list.emplace_back("analysis/count", std::to_string(scene.analysis.modes.count));
      list.emplace_back("analysis/shift", number(scene.analysis.modes.shift));
      list.emplace_back("analysis/damping", scene.analysis.modes.damping ? "true" : "false");
    }
  } else if (kind.is_in_time) {
    if (scene.analysis.start == scene::StartKind::equilibrium)
      list.emplace_back("analysis/start", quoted("equilibrium"));
    list.emplace_back("analysis/end_time", number(scene.analysis.end_time));
    list.emplace_back("analysis/step_size", number(scene.analysis.step_size));
  }
  if (kind.integrates) {
    if (o.integrator == scene::Integrator::variational) {
      list.emplace_back("analysis/integrator", quoted("variational"));
      list.emplace_back("analysis/newmark_beta", number(o.newmark_beta));
    } else if (o.integrator == scene::Integrator::bdf) {
      list.emplace_back("analysis/integrator", quoted("bdf"));
      list.emplace_back("analysis/bdf_order", std::to_string(o.bdf_order == 2 ? 2 : 3));
    } else {
      const step::AlphaCoefficients c = step::make_alpha_coefficients(o.spectral_radius);
      list.emplace_back("analysis/integrator", quoted("generalized_alpha"));
      list.emplace_back("analysis/spectral_radius", number(o.spectral_radius));
      list.emplace_back("analysis/alpha_m", number(c.alpha_m));
      list.emplace_back("analysis/alpha_f", number(c.alpha_f));
      list.emplace_back("analysis/beta", number(c.beta));
      list.emplace_back("analysis/gamma", number(c.gamma));
    }
    if (o.step_control) {
      const scene::StepControl& c = *o.step_control;
      list.emplace_back("analysis/step_control/tolerance", number(c.tolerance));
      list.emplace_back("analysis/step_control/position_tolerance", number(c.position_tolerance));
      list.emplace_back("analysis/step_control/rotation_tolerance", number(c.rotation_tolerance));
      list.emplace_back("analysis/step_control/velocity_tolerance", number(c.velocity_tolerance));
      list.emplace_back("analysis/step_control/angular_velocity_tolerance", number(c.angular_velocity_tolerance));
      if (c.largest_step > 0.0) list.emplace_back("analysis/step_control/largest_step", number(c.largest_step));
    }
  } else if (o.arc_length) {
    const scene::ArcLength& l = *o.arc_length;
    if (l.step > 0.0) list.emplace_back("analysis/arc_length/step", number(l.step));
    if (l.largest_step > 0.0) list.emplace_back("analysis/arc_length/largest_step", number(l.largest_step));
    list.emplace_back("analysis/arc_length/max_steps", std::to_string(l.max_steps));
    if (l.end_at_limit_point > 0) {
      list.emplace_back("analysis/arc_length/end_at_limit_point", std::to_string(l.end_at_limit_point));
    } else {
      list.emplace_back("analysis/arc_length/end_load_factor", number(l.end_load_factor));
      list.emplace_back("analysis/arc_length/after_limit_points", std::to_string(l.after_limit_points));
    }
  } else if (scene.analysis.kind == scene::AnalysisKind::buckling) {
    list.emplace_back("analysis/count", std::to_string(scene.analysis.buckling.count));
    list.emplace_back("analysis/largest_factor", number(scene.analysis.buckling.largest_factor));
  } else if (!kind.is_in_time) {
    list.emplace_back("analysis/load_steps", std::to_string(scene.analysis.load_steps));
  }
  if (kind.integrates || !kind.is_in_time) {
    list.emplace_back("analysis/newton", quoted(o.single_solution ? "single" : "full"));
    list.emplace_back("analysis/tolerance", number(o.tolerance));
    list.emplace_back("analysis/max_iterations", std::to_string(o.max_iterations));
  }
  if (!kind.is_of_instant) list.emplace_back("analysis/max_cuts", std::to_string(o.max_cuts));
  const scene::SolverForm form = scene.solver.form;
  list.emplace_back("solver/form", quoted(scene::to_string(form)));
  if (form == scene::SolverForm::monolithic) {
    static const char* const libraries[] = {"klu", "sparse_lu", "umfpack", "cholmod"};
    list.emplace_back("solver/library", quoted(libraries[static_cast<int>(scene.solver.library)]));
  }
  if (form == scene::SolverForm::global || form == scene::SolverForm::hybrid)
    list.emplace_back("solver/interface_solution", quoted(scene.solver.iterate_interface ? "iterative" : "direct"));
  list.emplace_back("solver/leaf_size", std::to_string(scene.solver.leaf_size));
  list.emplace_back("solver/depth", std::to_string(scene.solver.depth));
  if (form == scene::SolverForm::augmented)
    list.emplace_back("solver/penalty_factor", number(scene.solver.penalty_factor));
  list.emplace_back("solver/tasks", scene.solver.tasks ? "true" : "false");
  list.emplace_back("output/stride", std::to_string(scene.output.stride));
  list.emplace_back("output/checks", scene.output.checks ? "true" : "false");
  return list;
}

}  // namespace bough::run
