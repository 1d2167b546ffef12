#include "bough/results/balance.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "observe_parts.hpp"

namespace bough::results {

using elements::Field;
using elements::Measures;
using motion::Vec3;
using motion::Vec6;

namespace {

/// Whether an element does work, dissipates energy or loads the ground in every step.
template <class E>
bool is_watched(const E& e) {
  return holds_on_to_ground(e) || exchanges_energy(e);
}

/// Whether a port is fixed to a frame of prescribed motion, which does work through the port.
bool is_moved(const plan::Plan& plan, const elements::Port& port) {
  return port.node == elements::ground && (port.carrier >= 0 || plan.observer >= 0);
}

/// Pose of a port in the ground.
template <class E>
void eval_ports(const E& e, const Field& f, elements::PortMotion<double>* ports) {
  const motion::Vec3Pair origin = motion::Vec3Pair::from(Vec3<double>::zero());
  for (int k = 0; k < E::num_ports; ++k) ports[k] = elements::eval_port(e.ports[k], f.nodes, origin, f.carriers);
}
/// The same pose in the inertial frame.
motion::Frame<double> inertial_pose(const Field& f, const motion::Frame<double>& pose) {
  return f.observer == nullptr ? pose : motion::compose(f.observer->pose, pose);
}

/// Work of frames of prescribed motion through the ports fixed to them since `last`; `last` is updated to the present.
template <class E, class P>
double advance_grounds(const plan::Plan& plan, const E& e, const Field& f, const double* multipliers, double turns,
                       P* last) {
  if (std::none_of(std::begin(e.ports), std::end(e.ports), [&](const auto& p) { return is_moved(plan, p); }))
    return 0.0;
  elements::PortMotion<double> ports[E::num_ports];
  eval_ports(e, f, ports);
  double out[6 * E::num_ports + E::num_multipliers];
  if constexpr (E::num_multipliers > 0)
    elements::eval_residual(e, ports, multipliers, f.around, turns, out, out + 6 * E::num_ports);
  else
    elements::eval_residual(e, ports, f.around, out);
  double work = 0.0;
  for (int k = 0; k < E::num_ports; ++k) {
    if (!is_moved(plan, e.ports[k])) continue;
    P now;
    now.pose = inertial_pose(f, ports[k].H);
    for (int i = 0; i < 6; ++i)
      now.wrench[i] = out[6 * k + i];  // a residual at the ground is the reaction of the ground
    work += lanes::dot(Vec6<double>(0.5 * (last->wrench + now.wrench)),
                       motion::Se3::log(motion::relative(last->pose, now.pose)));
    *last++ = now;
  }
  return work;
}

/// Work of a load since `last`, which is updated to the present.
template <class E, class P>
double advance_load(const E& e, const Field& f, P* last) {
  constexpr auto n = static_cast<std::size_t>(E::num_ports);
  elements::PortMotion<double> ports[n];
  eval_ports(e, f, ports);
  double out[6 * n];
  elements::eval_residual(e, ports, f.around, out);
  double work = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    P now;
    now.pose = inertial_pose(f, ports[k].H);
    for (std::size_t i = 0; i < 6; ++i) now.wrench[static_cast<int>(i)] = -out[6 * k + i];
    const Vec6<double> way = motion::Se3::log(motion::relative(last[k].pose, now.pose));
    const Vec6<double> mean = 0.5 * (last[k].wrench + now.wrench);
    if (e.follows) {
      work += lanes::dot(mean, way);
    } else {
      const Vec3<double> force =
          0.5 * (last[k].pose.R * lanes::linear_part(last[k].wrench) + now.pose.R * lanes::linear_part(now.wrench));
      work += lanes::dot(force, now.pose.x - last[k].pose.x) +
              lanes::dot(lanes::angular_part(mean), lanes::angular_part(way));
    }
    last[k] = now;
  }
  return work;
}

}  // namespace

WorkMeter::WorkMeter(const plan::Plan& plan) {
  std::vector<int> joint_of(plan.directory.size(), -1);
  for (std::size_t j = 0; j < plan.joints.size(); ++j)
    joint_of[static_cast<std::size_t>(plan.joints[j].element)] = static_cast<int>(j);
  for (std::size_t id = 0; id < plan.directory.size(); ++id)
    plan::with_element(plan.elements, plan.directory[id], [&](const auto& e) {
      using E = std::decay_t<decltype(e)>;
      mass_ += total_mass(e);
      is_tied_ = is_tied_ || (E::num_ports > 1 && holds_on_to_ground(e));
      if (!is_watched(e)) return;
      evaluation_cost_ += E::cost.alone;
      watched_.push_back({id, joint_of[id], ports_.size(), drives_.size()});
      if constexpr (E::role == elements::Role::load)
        ports_.resize(ports_.size() + E::num_ports);
      else if constexpr (E::role == elements::Role::joint)
        drives_.resize(drives_.size() + static_cast<std::size_t>(e.num_rows + e.num_efforts));
      else if (stiffness_law(e) >= 0)
        drives_.emplace_back();
      if constexpr (elements::joins_two_frames(E::role))
        for (const elements::Port& p : e.ports)
          if (is_moved(plan, p)) ports_.emplace_back();
      for (const elements::Port& p : e.ports)
        if (p.node != elements::ground) nodes_.push_back(p.node);
    });
  std::unordered_map<int, std::size_t> drives_of;
  for (const Watched& w : watched_)
    if (w.joint >= 0) drives_of.emplace(w.joint, w.first_drive);
  for (const plan::EnergyStore& store : plan.energy_stores) {
    const int place = plan::joint_element(plan, store.joint).num_rows + store.effort;
    drives_[drives_of.at(store.joint) + static_cast<std::size_t>(place)].is_stored = true;
  }
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
}

double WorkMeter::step(const step::System& system, const step::State& state) {
  const plan::Plan& plan = system.plan();
  const Field f = system.instant().field_of(state, nodes_, scratch_);
  double work = 0.0;
  dissipation_rate_ = 0.0;
  force_ = moment_ = Vec3<double>::zero();
  const auto advance_drive = [&work](Drive& drive, double way, double force) {
    work += 0.5 * (drive.force + force) * (way - drive.way);
    drive.way = way;
    drive.force = force;
  };
  for (const Watched& w : watched_) {
    plan::with_element(plan.elements, plan.directory[w.element], [&](const auto& e) {
      using E = std::decay_t<decltype(e)>;
      const double* multipliers = nullptr;
      double turns = 0.0;
      if constexpr (E::role == elements::Role::joint) {
        const auto j = static_cast<std::size_t>(w.joint);
        multipliers = state.multipliers.data() + plan.joints[j].multiplier_begin;
        turns = state.turns[j];
        Drive* drive = drives_.data() + w.first_drive;
        for (int k = 0; k < e.num_rows; ++k, ++drive)
          if (e.rows[k].law >= 0)
            advance_drive(*drive, system.instant().law_values()[static_cast<std::size_t>(e.rows[k].law)],
                          -multipliers[k]);
        for (int k = 0; k < e.num_efforts; ++k, ++drive)
          if (e.efforts[k].law >= 0 && !drive->is_stored)
            advance_drive(*drive, elements::eval_joint_coordinate(e, e.efforts[k].coordinate, f, turns).value,
                          system.instant().law_values()[static_cast<std::size_t>(e.efforts[k].law)]);
      } else if constexpr (E::role == elements::Role::load) {
        work += advance_load(e, f, ports_.data() + w.first_port);
      }
      if constexpr (elements::joins_two_frames(E::role))
        if (f.carriers != nullptr)
          work += advance_grounds(plan, e, f, multipliers, turns, ports_.data() + w.first_port);
      const Measures m = elements::measure(e, f, multipliers, turns);
      if (const int law = stiffness_law(e); law >= 0)
        advance_drive(drives_[w.first_drive], system.instant().law_values()[static_cast<std::size_t>(law)],
                      m.strain_by_law);
      dissipation_rate_ += m.dissipation_rate;
      force_ += m.force;
      moment_ += m.moment;
    });
  }
  force_ += mass_ * f.around.gravity;
  if (f.observer != nullptr) {  // elements give forces in the ground's axes
    force_ = f.observer->pose.R * force_;
    moment_ = f.observer->pose.R * moment_;
  }
  return work;
}

void WorkMeter::begin(const step::System& system, const step::State& state) { (void)step(system, state); }

void WorkMeter::add(const step::System& system, const step::State& state, double h) {
  const double dissipated = dissipation_rate_;
  const Vec3<double> force = force_, moment = moment_;
  supply_.work += step(system, state);
  supply_.dissipation += 0.5 * h * (dissipated + dissipation_rate_);
  supply_.impulse += (0.5 * h) * (force + force_);
  supply_.angular_impulse += (0.5 * h) * (moment + moment_);
  supply_.force += h * std::sqrt(lanes::dot(force_, force_));
  supply_.moment += h * std::sqrt(lanes::dot(moment_, moment_));
}

void Balance::begin(const Energies& start) {
  start_energy_ = start.total();
  start_momentum_ = start.momentum;
}

void Balance::jump(const Energies& before, const Energies& after) {
  start_energy_ += after.total() - before.total();
  start_momentum_ += after.momentum - before.momentum;
}

void Balance::compare(const Energies& now, const Supply& supply, double mass, double size) {
  const double supplied = supply.work - supply.dissipation;
  last_error_ = now.total() - start_energy_ - supplied;
  energy_error_ = std::max(energy_error_, std::abs(last_error_));
  // What dampers took has passed through the structure, and its integral has the error of what was supplied for it.
  const double passed = std::max(std::abs(supplied), supply.dissipation);
  energy_scale_ = std::max(energy_scale_, now.kinetic + now.strain + std::abs(now.potential - start_energy_) + passed);
  largest_energies_ = std::max(largest_energies_, now.kinetic + now.strain + std::abs(now.potential));
  const Vec6<double> change = now.momentum - start_momentum_;
  const double of_parts = std::sqrt(2.0 * mass * now.kinetic);  // sum of |p| <= (2 m T)^1/2
  momentum_scale_ = std::max(momentum_scale_, of_parts);
  angular_scale_ = std::max(angular_scale_, size * of_parts);
  for (int i = 0; i < 3; ++i) {
    momentum_error_ = std::max(momentum_error_, std::abs(change[i] - supply.impulse[i]));
    momentum_scale_ = std::max(momentum_scale_, std::abs(now.momentum[i]) + supply.force);
    angular_error_ = std::max(angular_error_, std::abs(change[3 + i] - supply.angular_impulse[i]));
    angular_scale_ = std::max(angular_scale_, std::abs(now.momentum[3 + i]) + supply.moment);
  }
}

}  // namespace bough::results
