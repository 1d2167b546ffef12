#include "limit_watch.hpp"

#include <algorithm>

#include "bough/io/number_text.hpp"

namespace bough::run {

LimitWatch::LimitWatch(const plan::Plan& plan)
    : owner_(plan.nodes.size(), -1),
      of_beam_(plan.beams.size()),
      of_node_(plan.nodes.size()),
      of_signal_(plan.signals.size(), 0) {
  for (std::size_t b = 0; b < plan.beams.size(); ++b)
    for (std::size_t k = 1; k + 1 < plan.beams[b].nodes.size(); ++k)  // ends may be bodies, or belong to other beams
      owner_[static_cast<std::size_t>(plan.beams[b].nodes[k])] = static_cast<int>(b);
}

void LimitWatch::count(const step::ErrorLimit& limit) {
  if (limit.is_energy) {
    ++of_energy_;
    ++all_;
  }
  if (limit.signal >= 0) {
    ++of_signal_[static_cast<std::size_t>(limit.signal)];
    ++all_;
  }
  if (limit.node < 0) return;
  const auto node = static_cast<std::size_t>(limit.node);
  Limit& l = owner_[node] < 0 ? of_node_[node] : of_beam_[static_cast<std::size_t>(owner_[node])];
  ++l.steps;
  l.of_velocity += limit.is_velocity ? 1 : 0;
  l.frequencies += limit.frequency;
  ++all_;
}

std::optional<std::string> LimitWatch::text(const plan::Plan& plan, double tolerance) const {
  const auto fewer = [](const Limit& a, const Limit& b) { return a.steps < b.steps; };
  const auto beam = std::max_element(of_beam_.begin(), of_beam_.end(), fewer);
  const auto node = std::max_element(of_node_.begin(), of_node_.end(), fewer);
  const bool is_beam = beam != of_beam_.end() && (node == of_node_.end() || beam->steps >= node->steps);
  const long most = is_beam ? beam->steps : node != of_node_.end() ? node->steps : 0;
  const auto share = [&](long steps) {
    return std::to_string((100 * steps + (all_ + at_largest_) / 2) / (all_ + at_largest_)) + " % of the steps";
  };
  const auto signal = std::max_element(of_signal_.begin(), of_signal_.end());
  const long of_signal = signal == of_signal_.end() ? 0 : *signal;
  if (most == 0 && of_energy_ == 0 && at_largest_ == 0 && of_signal == 0) return std::nullopt;
  if (of_signal > std::max({most, of_energy_, at_largest_}))
    return "the tolerance of " + io::rounded_text(tolerance, 2) + " for the error of the state '" +
           plan.signals[static_cast<std::size_t>(signal - of_signal_.begin())].name + "' decided the size of " +
           share(of_signal);
  if (of_energy_ > std::max(most, at_largest_))
    return "the tolerance of " + io::rounded_text(tolerance, 2) + " for the error of energies decided the size of " +
           share(of_energy_);
  if (at_largest_ >= most)
    return "the largest step allowed decided the size of " + share(at_largest_) + ", no error did";
  const Limit& limit = is_beam ? *beam : *node;
  const double frequency = limit.frequencies / static_cast<double>(limit.steps);
  const std::string name = is_beam ? "beam '" + plan.beams[static_cast<std::size_t>(beam - of_beam_.begin())].name + "'"
                                   : "'" + plan.nodes[static_cast<std::size_t>(node - of_node_.begin())].name + "'";
  return "the tolerance of " + io::rounded_text(tolerance, 2) + " for the error of " +
         (2 * limit.of_velocity > limit.steps ? "velocities" : "the place") + " of " + name + " decided the size of " +
         share(limit.steps) + "; it moves there at about " + io::rounded_text(frequency, 2) + " rad/s";
}

}  // namespace bough::run
