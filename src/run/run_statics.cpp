#include <algorithm>

#include "run.hpp"

namespace bough::run {

using records::RunStatus;

/// From a load factor over `width`. A step that fails is halved, and doubled again after success.
bool Run::take_load_step(double from, double width, bool is_last) {
  int level = 0;  // the step is cut into 2^level parts
  long part = 0;  // parts of the present level done
  while (part < (1L << level)) {
    const bool is_end = is_last && part + 1 == (1L << level);
    const double target =
        is_end ? 1.0 : from + width * static_cast<double>(part + 1) / static_cast<double>(1L << level);
    if (!may_try(target)) return false;
    const double before = state_.time;
    const step::StepReport report = step::equilibrate(system_, state_, options_, target);
    count(report);
    if (!report.converged) {
      if (++level > options_.max_cuts)
        return fail("no equilibrium at load factor " + std::to_string(target) + ": " + report.cause);
      part *= 2;
      continue;
    }
    stability_->look(state_);
    last_step_ = target - before;
    if (!plan_.joints.empty()) step::accept_turns(system_, state_);
    ++part;
    while (level > 0 && part % 2 == 0) {
      part /= 2;
      --level;
    }
    record(report.iterations, target == 1.0);
    if (!report_progress(report, 1.0)) return false;
  }
  return true;
}

/// Load steps of equal width; one within which a figure is asked for ends there, and goes on to its own end.
bool Run::run_statics() {
  if (const auto t = system_.set_time(0.0)) return fail(t->text);
  record(0, false);
  const int steps = std::max(1, scene_.analysis.load_steps);
  const double width = 1.0 / steps;
  for (int k = 0; k < steps; ++k) {
    double from = static_cast<double>(k) / steps;
    const double end = from + width;
    for (const double stop : stops_between(from, end)) {
      const double part = from == static_cast<double>(k) / steps && stop == end ? width : stop - from;
      if (!take_load_step(from, part, k + 1 == steps && stop == end)) return false;
      from = stop;
    }
  }
  summary_.status = RunStatus::ok;
  return true;
}

}  // namespace bough::run
