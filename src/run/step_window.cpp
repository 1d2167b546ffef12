#include "step_window.hpp"

#include <algorithm>
#include <utility>

#include "bough/step/between.hpp"

namespace bough::run {

namespace {

bool shows_motion(const plan::Plan& plan, int sensor) {
  return results::shows_motion(plan.sensors[static_cast<std::size_t>(sensor)].sensor.kind);
}

}  // namespace

StepWindow::StepWindow(const plan::Plan& plan, std::vector<int> sensors) : plan_(plan), sensors_(std::move(sensors)) {
  value_begin_.push_back(0);
  for (const int k : sensors_) {
    const plan::SensorPlan& sensor = plan.sensors[static_cast<std::size_t>(k)];
    value_begin_.push_back(value_begin_.back() + sensor.components.size());
    nodes_of_.emplace_back();
    if (shows_motion(plan, k)) results::append_nodes_of(plan, sensor, nodes_of_.back());
    nodes_.insert(nodes_.end(), nodes_of_.back().begin(), nodes_of_.back().end());
  }
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  for (std::vector<int>& list : nodes_of_)
    for (int& node : list)
      node = static_cast<int>(std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin());
  between_.emplace<motion::Se3>().motion.resize(plan.nodes.size());
  between_.turns.resize(plan.joints.size());
  between_.signals.value.resize(plan.signals.size());
}

void StepWindow::push(const step::System& system, const step::State& state, results::EnergyMeter& meter) {
  if (num_ends_ == most_ends)
    std::rotate(ends_.begin(), ends_.begin() + 1, ends_.end());
  else
    ++num_ends_;
  End& end = ends_[static_cast<std::size_t>(num_ends_ - 1)];
  end.time = state.time;
  end.nodes.clear();
  std::vector<elements::NodeMotion>& nodes = between_.change<motion::Se3>().motion;
  step::copy_nodes_in_space(plan_, state, nodes_, nodes);
  for (const int node : nodes_) end.nodes.push_back(nodes[static_cast<std::size_t>(node)]);
  end.turns = state.turns;
  results::eval_sensors(system, state, meter, sensors_, end.values);
}

std::span<const double> StepWindow::values(int end, int k) const {
  const auto sensor = static_cast<std::size_t>(k);
  return std::span(ends_[static_cast<std::size_t>(end)].values)
      .subspan(value_begin_[sensor], value_begin_[sensor + 1] - value_begin_[sensor]);
}

std::span<const double> StepWindow::values_between(step::System& system, results::EnergyMeter& meter, int interval,
                                                   double time, int k) {
  const auto sensor = static_cast<std::size_t>(k);
  if (!shows_motion(plan_, sensors_[sensor])) {
    found_.assign(value_begin_[sensor + 1] - value_begin_[sensor], 0.0);
    for (int i = 0; i < num_ends_; ++i) {
      double weight = 1.0;  // Lagrange polynomial of this end
      for (int j = 0; j < num_ends_; ++j)
        if (j != i) weight *= (time - this->time(j)) / (this->time(i) - this->time(j));
      const std::span<const double> at_end = values(i, k);
      for (std::size_t c = 0; c < found_.size(); ++c) found_[c] += weight * at_end[c];
    }
    return found_;
  }
  const End &first = ends_[static_cast<std::size_t>(interval)], &last = ends_[static_cast<std::size_t>(interval) + 1];
  const double h = last.time - first.time, part = (time - first.time) / h;
  std::vector<elements::NodeMotion>& nodes = between_.change<motion::Se3>().motion;
  for (const int i : nodes_of_[sensor]) {
    const auto place = static_cast<std::size_t>(i);
    step::eval_between(first.nodes[place], last.nodes[place], h, part, nodes[static_cast<std::size_t>(nodes_[place])]);
  }
  between_.time = time;
  if (const int joint = plan_.sensors[static_cast<std::size_t>(sensors_[sensor])].joint; joint >= 0)
    between_.turns[static_cast<std::size_t>(joint)] =
        (part < 0.5 ? first : last).turns[static_cast<std::size_t>(joint)];
  if (!plan_.frames.empty() && system.set_time(time)) return {};
  results::eval_sensors(system, between_, meter, std::span(sensors_).subspan(sensor, 1), found_);
  return found_;
}

}  // namespace bough::run
