#pragma once
/// Balances of energy and momentum over a run. Their defect is the energy and momentum that the integrator adds or
/// removes.
#include <vector>

#include "bough/results/energies.hpp"

namespace bough::results {

/// Work, dissipation and impulse supplied to the structure since the run began.
struct Supply {
  double work = 0.0;         ///< of loads, drives, efforts and of a ground that moves [J]
  double dissipation = 0.0;  ///< taken by dampers [J]
  /// Of gravity, loads and the ground, in inertial axes, and its moment about the inertial origin without gravity [N s,
  /// N m s]; `force` and `moment` sum the magnitudes.
  motion::Vec3<double> impulse = motion::Vec3<double>::zero(), angular_impulse = impulse;
  double force = 0.0, moment = 0.0;
};

/// Sums work, dissipation and impulse over the steps. Only elements that do work, dissipate energy or are attached to
/// the ground are evaluated. They have to be evaluated in every step, whereas energies and momentum are needed only
/// where results are wanted.
///  loads    W = sum of 1/2 (F_n + F_{n+1}) . (displacement from n to n+1); forces of fixed direction in inertial axes,
///           others in the axes of the body with the displacement log(H_n^-1 H_{n+1}): exact where they are constant
///   drives   W = -1/2 (lambda_n + lambda_{n+1}) (law_{n+1} - law_n),   efforts alike over their coordinate, unless
///            they store their energy (plan::EnergyStore)
///   factors  of the stiffness of couplings  W = 1/2 (E_n + E_{n+1}) (k_{n+1} - k_n), E the strain energy at k = 1
///  grounds  with prescribed motion: the work of their wrenches on the structure, computed like follower loads
///   dampers and impulses by the trapezoidal rule
/// Displacements, work and impulse are those in the inertial frame, in whatever frame the analysis is described.
class WorkMeter {
 public:
  explicit WorkMeter(const plan::Plan& plan);
  /// Starts with the present forces (at the start of a run, or after a jump).
  void begin(const step::System& system, const step::State& state);
  /// Adds the contribution of a step; call it after every accepted step.
  void add(const step::System& system, const step::State& state, double step_size);
  void checkpoint(records::Archive& archive) { archive(ports_, drives_, dissipation_rate_, force_, moment_, supply_); }
  const Supply& supply() const { return supply_; }
  double mass() const { return mass_; }  ///< total mass [kg]
  /// Whether something ties the structure to the ground. The impulse of its reactions, which are known at the ends of
  /// steps alone, is then no better than these resolve them.
  bool is_tied() const { return is_tied_; }
  /// Sum of elements::Cost::alone over the elements that are evaluated in every step [s].
  double evaluation_cost() const { return evaluation_cost_; }

 private:
  /// A force or multiplier with its conjugate displacement: a port's pose with its wrench in the port's axes, or a
  /// number with its conjugate coordinate.
  struct Port {
    motion::Frame<double> pose = motion::Frame<double>::identity();
    motion::Vec6<double> wrench = motion::Vec6<double>::zero();
  };
  struct Drive {
    double way = 0.0, force = 0.0;
    bool is_stored = false;  ///< its energy is part of the strain energy, and it does no work
  };
  struct Watched {
    std::size_t element = 0;
    int joint = -1;
    std::size_t first_port = 0, first_drive = 0;  ///< in `ports_`, `drives_`
  };
  double step(const step::System& system, const step::State& state);  ///< work since the last call

  std::vector<int> nodes_;                     ///< nodes of the evaluated elements
  std::vector<elements::NodeMotion> scratch_;  ///< of field_of
  std::vector<Watched> watched_;
  std::vector<Port> ports_;
  std::vector<Drive> drives_;
  double mass_ = 0.0;  ///< total mass [kg]
  bool is_tied_ = false;
  double evaluation_cost_ = 0.0;
  double dissipation_rate_ = 0.0;
  motion::Vec3<double> force_ = motion::Vec3<double>::zero(), moment_ = force_;
  Supply supply_;
};

/// Defect of the balances of energy and momentum: their change minus what was supplied.
class Balance {
 public:
  void begin(const Energies& start);
  /// Excludes the change of energy and momentum by a jump of velocities at a breakpoint, which is no error.
  void jump(const Energies& before, const Energies& after);
  /// Evaluates the defects at a time where results are wanted, of a structure of this mass [kg] and size [m].
  void compare(const Energies& now, const Supply& supply, double mass, double size);
  void checkpoint(records::Archive& archive) {
    archive(start_energy_, start_momentum_, momentum_scale_, angular_error_, angular_scale_, energy_error_,
            energy_scale_, last_error_, momentum_error_, largest_energies_);
  }

  double energy_error() const { return energy_error_; }  ///< largest |energy - work + dissipation - start| seen [J]
  double energy_scale() const { return energy_scale_; }  ///< largest sum of magnitudes of the terms so far [J]
  double largest_energies() const {
    return largest_energies_;
  }                                                         ///< largest sum of the magnitudes of the energies so
                                                            ///< far [J]
  double last_energy_error() const { return last_error_; }  ///< signed: negative is energy taken by the integrator [J]
  /// Largest |momentum - impulse - start| seen, linear and about the inertial origin, and what they are compared
  /// with: the largest momentum and impulse, but no less than (2 mass kinetic energy)^1/2 [kg m/s, kg m^2/s].
  double momentum_error() const { return momentum_error_; }
  double momentum_scale() const { return momentum_scale_; }
  double angular_momentum_error() const { return angular_error_; }
  double angular_momentum_scale() const { return angular_scale_; }

 private:
  double start_energy_ = 0.0;  ///< energy at the start, plus the changes by jumps
  motion::Vec6<double> start_momentum_ = motion::Vec6<double>::zero();
  double momentum_scale_ = 0.0, angular_error_ = 0.0, angular_scale_ = 0.0;
  double energy_error_ = 0.0, energy_scale_ = 0.0, last_error_ = 0.0, momentum_error_ = 0.0, largest_energies_ = 0.0;
};

}  // namespace bough::results
