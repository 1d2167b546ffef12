#pragma once
/// Balances of energy and momentum over a run: what the integrator makes of them, apart from the work of loads and
/// drives.
#include <vector>

#include "bough/results/energies.hpp"

namespace bough::results {

/// What changed energy and momentum up to now, since the run began.
struct Supply {
  double work = 0.0;         ///< of loads, drives, efforts and of a ground that moves [J]
  double dissipation = 0.0;  ///< taken by dampers [J]
  motion::Vec3<double> impulse =
      motion::Vec3<double>::zero();  ///< of gravity, loads and the ground, inertial axes [N s]
};

/// Sums work, dissipation and impulse over the steps. Looks only at elements that do work, take energy or hold on to
/// the ground: these have to be seen in every step, energies and momentum only where results are wanted.
///   loads    W = sum of 1/2 (F_n + F_{n+1}) . (the way from n to n+1), forces that keep their direction in inertial
///     axes, others in
///            those of the body with log(H_n^-1 H_{n+1}): exact where they are constant
///   drives   W = -1/2 (lambda_n + lambda_{n+1}) (law_{n+1} - law_n),   efforts alike over their coordinate
///   grounds  that move as prescribed: of their wrenches on the structure, as of loads that follow
///   dampers and impulses by the trapezoidal rule
/// Ways, work and impulse are those in the inertial frame, whatever frame the analysis is described in.
class WorkMeter {
 public:
  explicit WorkMeter(const plan::Plan& plan);
  /// Forces as they are now (at the start, or past a jump) count from here.
  void begin(const step::System& system, const step::State& state);
  /// After an accepted step.
  void add(const step::System& system, const step::State& state, double step_size);
  const Supply& supply() const { return supply_; }
  double mass() const { return mass_; }  ///< of everything [kg]

 private:
  /// A force or multiplier and what it works on: a port's pose with its wrench in the port's axes, or a number with
  /// its conjugate.
  struct Port {
    motion::Frame<double> pose = motion::Frame<double>::identity();
    motion::Vec6<double> wrench = motion::Vec6<double>::zero();
  };
  struct Drive {
    double way = 0.0, force = 0.0;
  };
  struct Watched {
    std::size_t element = 0;
    int joint = -1;
    double mass = 0.0;                            ///< whose weight Measures::load holds; counted with the whole [kg]
    std::size_t first_port = 0, first_drive = 0;  ///< in `ports_`, `drives_`
  };
  double step(const step::System& system, const step::State& state);  ///< work since the last call

  std::vector<int> nodes_;                     ///< that it looks at
  std::vector<elements::NodeMotion> scratch_;  ///< of field_of
  std::vector<Watched> watched_;
  std::vector<Port> ports_;
  std::vector<Drive> drives_;
  double mass_ = 0.0;  ///< of everything [kg]
  double dissipation_rate_ = 0.0;
  motion::Vec3<double> force_ = motion::Vec3<double>::zero();
  Supply supply_;
};

/// What the integrator makes of energy and momentum: their change less what was supplied.
class Balance {
 public:
  void begin(const Energies& start);
  /// The energy and the momentum of a jump of velocities at a breakpoint are no error.
  void jump(const Energies& before, const Energies& after);
  /// Where results are wanted.
  void compare(const Energies& now, const Supply& supply);

  double energy_error() const { return energy_error_; }  ///< largest |energy - work + dissipation - start| seen [J]
  double energy_scale() const { return energy_scale_; }  ///< largest sum of magnitudes seen [J]
  double largest_energies() const { return largest_energies_; }  ///< largest sum of their magnitudes as they are [J]
  double last_energy_error() const { return last_error_; }  ///< signed: negative is energy taken by the integrator [J]
  double momentum_error() const {
    return momentum_error_;
  }  ///< largest |linear momentum - impulse - start| seen [kg m/s]

 private:
  double start_energy_ = 0.0;  ///< and that of the jumps
  motion::Vec3<double> start_momentum_ = motion::Vec3<double>::zero();
  double energy_error_ = 0.0, energy_scale_ = 0.0, last_error_ = 0.0, momentum_error_ = 0.0, largest_energies_ = 0.0;
};

}  // namespace bough::results
