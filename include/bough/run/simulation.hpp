#pragma once
/// A simulation that a program controls: it takes single steps or runs to a time, sensors can be read in between, and
/// it can be set back to an earlier moment.
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bough/run/simulate.hpp"

namespace bough::run {

/// The simulation of one scene, in time or along its loads (then "time" is the load factor). Rows, pictures and the
/// summary are passed to a recorder, if there is one. The scene and the recorder must outlive the simulation. Failures
/// are reported in the summary; exceptions of a recorder are passed on. Not for use by several threads at once.
class Simulation {
 public:
  /// Precondition: problems_in(scene) is empty (refusal_of gives the problems). Makes the plan and allocates all memory
  /// that steps need; nothing is simulated yet.
  explicit Simulation(const scene::Scene& scene, SimulateOptions options = {}, records::Recorder* recorder = nullptr,
                      ProgressCallback progress = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// Computes the first equilibrium, or the consistent initial state in dynamics, unless this was done. The other
  /// functions call it if necessary. False: it failed.
  bool start();
  /// Takes one accepted step. False: no step was accepted, because the simulation had ended or ends now.
  bool take_step();
  /// Takes steps until the time is reached, which is rounded up to the end of a step. False: it ended before.
  bool advance_to(double time);
  /// Takes steps to the end. False: the simulation failed or was interrupted.
  bool run();

  /// True if nothing more is simulated: the end was reached, a step failed, or a callback has stopped the run.
  bool has_ended() const;
  double time() const;  ///< [s], or the load factor
  double size() const;  ///< of the structure at the start [m]

  /// Names and units of all components of sensors, and their present values in the same order.
  const records::HistoryHeader& header() const;
  const std::vector<double>& values();
  /// One of these values, by "<sensor>.<component>" or "<sensor>"; throws std::out_of_range if there is none, which
  /// tells the names that there are.
  double value(std::string_view column);

  /// Sets a signal of kind "input", from the present time on. The next step starts anew, as at a jump of a law, unless
  /// the value is the one that the signal has. Returns empty, or why it cannot be set: no input has this name, the
  /// value is not finite, or the simulation has ended.
  [[nodiscard]] std::string set_input(std::string_view signal, double value);

  /// A saved moment of this simulation: a copy of all data that steps change.
  class Moment;
  std::shared_ptr<const Moment> save() const;
  /// Goes back to a moment of this simulation. Further steps equal the earlier ones up to the tolerance of Newton's
  /// method, since the stored factorization is discarded and computed anew. Rows and pictures that were passed to the
  /// recorder are not withdrawn.
  void restore(const Moment& moment);

  /// Ends the simulation, completes the summary with its checks, passes it to the recorder and returns it (as
  /// `simulate` does).
  const records::Summary& finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bough::run
