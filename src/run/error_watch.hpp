#pragma once
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "bough/plan/plan.hpp"
#include "bough/records/run.hpp"

namespace bough::run {

/// Estimates the discretization error in time, at the end of a run, of sensors that show motions.
///
/// In some steps the local error is measured as a displacement e_q of all nodes. Sensors are then evaluated at the
/// state and at the state displaced by e_q, with velocities changed by e_q / h. For a position or an angle the
/// difference is its local error d in this step; for a velocity it is d / h, with d the local error of its integral.
/// Between two measurements, d is assumed to be proportional to a norm of the local error that is known for every step.
/// The sum of |d| over all steps is then
///   A = sum |d| / norm (mean of two looks) . (sum of the norms between them)
/// The sum is one of absolute values because local errors of free motions accumulate to a shift tau in time: d ~
/// (dx/dt) tau with a constant sign of tau. For velocities u the shift gives the error A rms(du/dt) / rms(u). Numerical
/// dissipation slows a free motion down. By the virial theorem, in a potential ~ q^n the kinetic energy is on average
/// the share k = n / (n + 2) of the energy E, and periods are ~ E^(1/n - 1/2), so
///   d(tau)/dt = |1 - 2k| / (2k) . (energy taken) / (largest energy),     error = tau rms(ds/dt)
/// The factor |1 - 2k| / (2k) is 1/2 for motion under inertia alone and 0 for linear vibrations. Motions prescribed by
/// drives or frames are not shifted in time.
class ErrorWatch {
 public:
  /// Factor by which the motion amplifies the sum of local errors. In 16 kinds of scene, from tops to flexible beams,
  /// the largest error of a sensor was 1.2 to 8 times A, typically 3 times (data/manual/theory/errors.md).
  static constexpr double growth = 3.0;

  explicit ErrorWatch(const plan::Plan& plan);
  /// Whether any sensor shows a motion.
  bool has_columns() const { return !columns_.empty(); }

  /// Extends the ranges of the columns by these values of the sensors.
  void see(const std::vector<double>& values);
  /// Adds an accepted step with a norm of its local error.
  void pass(double norm) { passed_ += norm; }
  /// Adds a measurement of the last of these steps, of size h: values of sensors at its start (empty: not known), at
  /// its end, and at its end displaced by the local error.
  void look(const std::vector<double>& before, const std::vector<double>& now, const std::vector<double>& displaced,
            double norm, double h);
  /// Follows the columns over consecutive steps; is_next: the last values are those of the step before.
  void follow(const std::vector<double>& values, bool is_next);
  /// By how much the fastest motion that a column shows, with more than a hundredth of its range, turns in a step [rad].
  double turn() const;
  /// Adds what the error carried to a state makes of the columns: values there, and at the state displaced by `share` of
  /// the error. share: 0 if there is no error, below 0 if it is not finite.
  void carry(const std::vector<double>& now, const std::vector<double>& displaced, double share);
  /// Share of the size of the structure, or rad, of displacements by which an error is looked at: so small that sensors
  /// are linear in it.
  static constexpr double small = 1e-6;
  /// To be called if the errors carried along hold: they take the place of the sums. Of those that are larger than the
  /// sums this part is certain.
  void take_carried(double certain_part) {
    takes_carried_ = true;
    certain_part_ = certain_part;
  }
  /// Adds the energies of a row [J]: kinetic energy, all other energy, energy dissipated by the integrator so far, and
  /// the largest energy so far.
  void see_energies(double time, double kinetic, double other, double taken, double largest);

  void checkpoint(records::Archive& archive) {
    archive(columns_, least_range_, passed_, certain_part_, followed_, has_looked_, has_carried_, takes_carried_,
            rated_, has_energies_, begin_, last_time_, taken_, kinetic_, other_, last_taken_, least_other_, largest_);
  }

  /// Estimated errors of all columns of motion sensors, in the order of the header.
  std::vector<records::SensorError> errors(const records::HistoryHeader& header) const;

 private:
  struct Column {
    std::size_t index = 0, group = 0;     ///< index in the header; in `least_range_`
    bool is_rate = false, jumps = false;  ///< a velocity; a rotation vector or a quaternion
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;  ///< range of values
    double share = 0.0;                                                          ///< |d| / norm at the last measurement
    double sum = 0.0;                                                            ///< A so far
    double last = 0.0, step = 0.0;                    ///< values followed: the last, and its change
    double squared_steps = 0.0, squared_bends = 0.0;  ///< fading sums of squared changes, and of their changes
    double carried = 0.0;                             ///< largest error carried so far
    double squares = 0.0;                             ///< sum of squared values at measurements
    double squared_rates = 0.0;                       ///< sum of squared ds/dt at measurements
  };
  double slowed_by() const;

  std::vector<Column> columns_;
  std::vector<double> least_range_;  ///< by group of columns that share a unit and a sensor
  double passed_ = 0.0;              ///< sum of norms since the last measurement
  double certain_part_ = 1.0;
  int followed_ = 0;  ///< consecutive steps
  bool has_looked_ = false, has_carried_ = false, takes_carried_ = false;
  long rated_ = 0;          ///< number of measurements with rates
  bool is_driven_ = false;  ///< drives or frames prescribe a motion, which energy does not slow down
  bool has_energies_ = false;
  double begin_ = 0.0, last_time_ = 0.0;                         ///< first and last time of the energies [s]
  double taken_ = 0.0, kinetic_ = 0.0, other_ = 0.0;             ///< integrals over time [J s]
  double last_taken_ = 0.0, least_other_ = 0.0, largest_ = 0.0;  ///< [J]
};

}  // namespace bough::run
