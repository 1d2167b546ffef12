#pragma once
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "bough/plan/plan.hpp"
#include "bough/records/run.hpp"

namespace bough::run {

/// Estimates what the steps in time leave in the sensors of motions by the end of a run.
///
/// At a look the local error of the step is known as a displacement e_q of all nodes. Sensors are evaluated at the
/// state and at one displaced by it, with velocities changed by e_q / h: positions and angles show the change d of what
/// they measure in one step, velocities d / h of what their integral measures. Between looks the error goes with a norm
/// that each step tells, so the sum over n steps is
///   A = sum |d| / norm (mean of two looks) . (sum of the norms between them)
/// Absolute values, since in free motions local errors add up to a shift in time, d ~ (dx/dt) tau of one sign of tau.
/// For velocities u the shift gives A rms(du/dt) / rms(u). Energy that the integrator took makes a free motion slow: by
/// the virial theorem a potential ~ q^n, with a share k = n / (n + 2) of kinetic energy on average, has periods ~
/// E^(1/n - 1/2), so
///   d(tau)/dt = |1 - 2k| / (2k) . (energy taken) / (largest energy),     error = tau rms(ds/dt)
/// which is 1/2 where nothing but inertia is at work and 0 for linear vibrations. Where drives or frames prescribe a
/// motion, time is theirs.
class ErrorWatch {
 public:
  /// Sums of local errors grow on their way through the motion: in 16 kinds of scene, from tops to flexible beams, the
  /// largest error of a sensor was 1.2 to 8 times A, 3 in the middle (src/run/README.md).
  static constexpr double growth = 3.0;

  explicit ErrorWatch(const plan::Plan& plan);
  /// False: no sensor shows a motion, there is nothing to watch.
  bool has_columns() const { return !columns_.empty(); }

  /// What sensors show, for their ranges.
  void see(const std::vector<double>& values);
  /// An accepted step, with a norm of its local error.
  void pass(double norm) { passed_ += norm; }
  /// Of the last of these steps, of size h: sensors at its start (empty: not known), its end, and at its end displaced.
  void look(const std::vector<double>& before, const std::vector<double>& now, const std::vector<double>& displaced,
            double norm, double h);
  /// Energies at a row: kinetic and all other, taken by the integrator so far, largest so far [J].
  void see_energies(double time, double kinetic, double other, double taken, double largest);

  /// Estimates for all columns that were looked at, in the order of the header.
  std::vector<records::SensorError> errors(const records::HistoryHeader& header) const;

 private:
  struct Column {
    std::size_t index = 0, group = 0;     ///< in the header; in `least_range_`
    bool is_rate = false, jumps = false;  ///< a velocity; a rotation vector or a quaternion
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;  ///< seen
    double share = 0.0;                                                          ///< |d| / norm at the last look
    double sum = 0.0;                                                            ///< A so far
    double squares = 0.0;                                                        ///< of the values at looks
    double squared_rates = 0.0;                                                  ///< of ds/dt at looks
  };
  double slowed_by() const;

  std::vector<Column> columns_;
  std::vector<double> least_range_;  ///< by group of columns that share a unit and a sensor
  double passed_ = 0.0;              ///< norms since the last look
  bool has_looked_ = false;
  long rated_ = 0;          ///< looks that told rates
  bool is_driven_ = false;  ///< drives or frames prescribe a motion, which energy does not slow down
  bool has_energies_ = false;
  double begin_ = 0.0, last_time_ = 0.0;                         ///< of the energies seen [s]
  double taken_ = 0.0, kinetic_ = 0.0, other_ = 0.0;             ///< integrals over this time [J s]
  double last_taken_ = 0.0, least_other_ = 0.0, largest_ = 0.0;  ///< [J]
};

}  // namespace bough::run
