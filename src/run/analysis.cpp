#include "analysis.hpp"

#include <algorithm>
#include <stdexcept>

#include "load_path.hpp"
#include "load_steps.hpp"
#include "time_steps.hpp"

namespace bough::run {

Analysis::Analysis(const Parts& parts)
    : scene_(parts.scene),
      options_(parts.options),
      plan_(parts.plan),
      system_(parts.system),
      state_(parts.state),
      recording_(parts.recording),
      asked_(parts.asked),
      progress_(parts.progress) {}

void Analysis::come_back() {
  if (const auto t = system_.set_time(state_.time)) throw std::logic_error(t->text);  // it was finite there before
}

bool Analysis::may_try(double target) {
  const auto& ask = asked_.before_step;
  if (!ask || ask(system_, state_, {options_, summary().steps.accepted + 1, target})) return true;
  return account().interrupt("stopped before the step to " + std::to_string(target));
}

void Analysis::report_progress(const step::StepReport& report, double end) {
  if (!progress_) return;
  records::Progress p;
  p.time = state_.time;
  p.end_time = end;
  p.step_size = last_step_;
  p.iterations = report.iterations;
  p.step = summary().steps.accepted;
  if (progress_(p)) return;
  const auto& stopped_by = asked_.stopped_by;
  account().ask_to_stop("stopped by " + (stopped_by ? stopped_by() : std::string("the user")) + " at time " +
                        std::to_string(state_.time));
}

std::vector<double> Analysis::stops_between(double begin, double end) const {
  const double least = 1e-9 * (end - begin);
  std::vector<double> stops;
  for (const std::vector<double>* times : {&recording_.figures().times(), &asked_.stops})
    for (const double t : *times)
      if (t > begin + least && t < end - least) stops.push_back(t);
  std::sort(stops.begin(), stops.end());
  stops.erase(std::unique(stops.begin(), stops.end(), [&](double a, double b) { return b - a <= least; }), stops.end());
  stops.push_back(end);
  return stops;
}

std::unique_ptr<Analysis> make_inverse_dynamics(const Parts& parts);  // inverse_dynamics.cpp
std::unique_ptr<Analysis> make_modes(const Parts& parts);             // modes.cpp
std::unique_ptr<Analysis> make_response(const Parts& parts);          // response.cpp
std::unique_ptr<Analysis> make_linear_model(const Parts& parts);      // linear_model.cpp
std::unique_ptr<Analysis> make_buckling(const Parts& parts);          // buckling.cpp
std::unique_ptr<Analysis> make_campbell(const Parts& parts);          // campbell.cpp

namespace {

std::unique_ptr<Analysis> make_statics(const Parts& parts) {
  if (parts.options.arc_length) return std::make_unique<LoadPath>(parts);
  return std::make_unique<LoadSteps>(parts);
}

std::unique_ptr<Analysis> make_dynamics(const Parts& parts) {
  if (parts.options.step_control) return std::make_unique<ControlledSteps>(parts);
  return std::make_unique<EqualSteps>(parts);
}

}  // namespace

std::unique_ptr<Analysis> make_analysis(const Parts& parts) {
  switch (parts.scene.analysis.kind) {
    case scene::AnalysisKind::statics:
      return make_statics(parts);
    case scene::AnalysisKind::dynamics:
      return make_dynamics(parts);
    case scene::AnalysisKind::inverse_dynamics:
      return make_inverse_dynamics(parts);
    case scene::AnalysisKind::modes:
      return make_modes(parts);
    case scene::AnalysisKind::response:
      return make_response(parts);
    case scene::AnalysisKind::linear_model:
      return make_linear_model(parts);
    case scene::AnalysisKind::buckling:
      return make_buckling(parts);
    case scene::AnalysisKind::campbell:
      return make_campbell(parts);
  }
  throw std::logic_error("no analysis of this kind");
}

}  // namespace bough::run
