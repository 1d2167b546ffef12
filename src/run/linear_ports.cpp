#include "linear_ports.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bough/blocks/at.hpp"
#include "bough/results/observe.hpp"
#include "bough/scene/linear_inputs.hpp"

namespace bough::run {

using motion::Vec6;

namespace {

constexpr double far_enough =
    1e-2;  ///< displacement over the size of the structure, or rotation [rad], of a difference

/// ad(v) x = (w_v x u + u_v x w; w_v x w)
Vec6<double> ad_times(const Vec6<double>& v, const Vec6<double>& x) {
  const auto u_v = lanes::linear_part(v), w_v = lanes::angular_part(v), u = lanes::linear_part(x),
             w = lanes::angular_part(x);
  const motion::Vec3<double> linear = lanes::cross(w_v, u) + lanes::cross(u_v, w);
  return lanes::join(linear, lanes::cross(w_v, w));
}

}  // namespace

std::vector<LinearPort> inputs_of(const scene::Scene& scene, const step::System& system) {
  const std::vector<std::string> signals = scene::signals_of_inputs(scene);
  const plan::Plan& plan = system.plan();
  std::vector<LinearPort> ports;
  for (const std::string& name : signals) {
    const auto driving = plan::driving_signals(plan);
    const auto found = std::find_if(driving.begin(), driving.end(), [&](const auto& s) { return s.name == name; });
    if (found == driving.end()) throw std::logic_error("the input '" + name + "' is no unknown");
    const auto s = static_cast<std::size_t>(found - driving.begin());
    ports.push_back({name, found->unit == "-" ? "" : found->unit, system.places().signals()[s]});
  }
  return ports;
}

std::vector<LinearPort> outputs_of(const scene::Scene& scene, const records::HistoryHeader& header) {
  const std::vector<std::string>& wanted = scene.analysis.linear.outputs;
  std::vector<LinearPort> ports;
  for (std::size_t c = 0; c < header.columns.size(); ++c) {
    const std::string& column = header.columns[c];
    const auto is_of = [&](const std::string& name) {
      return column == name || (column.size() > name.size() && column.compare(0, name.size(), name) == 0 &&
                                column.find('.', name.size()) == name.size());
    };
    if (wanted.empty() || std::any_of(wanted.begin(), wanted.end(), is_of))
      ports.push_back({column, header.about[c].unit == "-" ? "" : header.about[c].unit, c});
  }
  return ports;
}

OutputSlopes::OutputSlopes(step::System& system, const step::State& state, const AboutState& about)
    : system_(system), state_(state), about_(about), meter_(system.plan()), displaced_(state) {}

/// About a state that moves with v, H = H_0 exp(v t) exp(x) is described from the parts, and H_0 exp(x) exp(v t) from
/// the ground. In own axes velocity and acceleration change by
///   x' + ad(v) x,  x'' + ad(v) x'     or     x',  x'' - ad(v) x'
void OutputSlopes::displace(double by, std::span<const double> x, std::span<const double> rate,
                            std::span<const double> second) {
  const plan::Plan& plan = system_.plan();
  const step::UnknownPlaces& places = system_.places();
  displaced_ = state_;
  for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
    const int node = static_cast<int>(n);
    if (places.node_begin(node) < 0) continue;
    const elements::NodeMotion at = step::nodes_in_space(plan, state_)[n];
    const Vec6<double> eta = places.node_part(x.data(), node), eta1 = places.node_part(rate.data(), node),
                       eta2 = places.node_part(second.data(), node);
    Vec6<double> v = eta1, a = eta2;
    if (about_.moves() && about_.is_from_ground()) a = a - ad_times(at.v, eta1);
    if (about_.moves() && !about_.is_from_ground()) {
      v = v + ad_times(at.v, eta);
      a = a + ad_times(at.v, eta1);
    }
    step::move_node(plan, displaced_, n, by * eta);
    step::set_velocity(plan, displaced_, n, at.v + by * v);
    step::set_acceleration(plan, displaced_, n, at.a + by * a);
  }
  for (const step::UnknownPlaces::Multiplier& m : places.multipliers())
    displaced_.multipliers[m.multiplier] += by * x[m.unknown];
  for (std::size_t s = 0; s < places.signals().size(); ++s) {
    displaced_.signals.value[s] += by * x[places.signals()[s]];
    if (plan.signals[s].is_state()) displaced_.signals.rate[s] += by * rate[places.signals()[s]];
  }
  system_.recover_multipliers(displaced_);
}

/// The largest displacement over the size of the structure, or rotation [rad].
double OutputSlopes::size_of_motion(std::span<const double> x) const {
  double largest = 0.0;
  for (std::size_t n = 0; n < system_.plan().nodes.size(); ++n) {
    const Vec6<double> eta = system_.places().node_part(x.data(), static_cast<int>(n));
    largest = std::max({largest, length_of(lanes::linear_part(eta)) / system_.plan().length_scale,
                        length_of(lanes::angular_part(eta))});
  }
  return largest;
}

const std::vector<double>& OutputSlopes::eval(std::span<const double> x, std::span<const double> rate,
                                              std::span<const double> second, double frequency) {
  static constexpr double weights[] = {0.75, -0.15, 1.0 / 60.0};
  double largest = size_of_motion(x);
  if (frequency > 0.0)
    largest = std::max({largest, size_of_motion(rate) / frequency, size_of_motion(second) / (frequency * frequency)});
  const double unit = largest > 0.0 ? far_enough / largest : 1.0;
  slopes_.clear();
  for (int k = 1; k <= 3; ++k)
    for (const double sign : {1.0, -1.0}) {
      displace(sign * k * unit, x, rate, second);
      results::eval_sensors(system_, displaced_, meter_, values_);
      slopes_.resize(values_.size(), 0.0);
      for (std::size_t c = 0; c < values_.size(); ++c) slopes_[c] += sign * weights[k - 1] / unit * values_[c];
    }
  return slopes_;
}

bool OutputSlopes::depend_on(std::size_t node, const std::vector<LinearPort>& outputs) {
  const auto eval_at = [&](double by, std::vector<double>& values) {
    std::vector<double> x(system_.places().size(), 0.0);
    const std::int64_t begin = system_.places().node_begin(static_cast<int>(node));
    for (int i = 0; i < system_.plan().unknowns.count_of(node); ++i) x[at(begin + i)] = 1.0 + 0.1 * i;
    displace(by, x, x, x);
    results::eval_sensors(system_, displaced_, meter_, values);
  };
  if (at_rest_.empty()) eval_at(0.0, at_rest_);
  eval_at(far_enough, values_);
  return std::any_of(outputs.begin(), outputs.end(),
                     [this](const LinearPort& port) { return values_[port.place] != at_rest_[port.place]; });
}

}  // namespace bough::run
