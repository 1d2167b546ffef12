#pragma once
/// A simulation that a program drives: step by step or to a time, with sensors read on the way, and taken back to where
/// it was.
#include <memory>
#include <string_view>
#include <vector>

#include "bough/run/simulate.hpp"

namespace bough::run {

/// One scene as it is simulated, in time or along its loads (then "time" is the load factor). Rows, pictures and the
/// summary go to a recorder, if there is one. The scene and the recorder outlive the simulation. Failures are told in
/// the summary; what a recorder throws passes through. Not for use by several threads at once.
class Simulation {
 public:
  /// Precondition: problems_in(scene) is empty (refusal_of tells what is wrong). Makes the plan and takes all memory
  /// that steps need; nothing is simulated yet.
  explicit Simulation(const scene::Scene& scene, SimulateOptions options = {}, records::Recorder* recorder = nullptr,
                      ProgressCallback progress = {});
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// Comes to the first equilibrium, or to the consistent start in time, where it is not there yet. The other verbs do
  /// it by themselves. False: it failed.
  bool start();
  /// Takes one accepted step. False: there is none, since the simulation has ended, or ends now.
  bool take_step();
  /// Takes steps until the time is reached, which is rounded up to the end of a step. False: it ended before.
  bool advance_to(double time);
  /// Takes steps to the end. False: the simulation failed or was interrupted.
  bool run();

  /// Nothing more is simulated: the end was reached, a step failed, or a callback has stopped it.
  bool has_ended() const;
  double time() const;  ///< [s], or the load factor

  /// Names and units of what sensors show, and their values now, in the same order.
  const records::HistoryHeader& header() const;
  const std::vector<double>& values();
  /// One of them, "<sensor>.<component>" or "<sensor>"; throws std::out_of_range where there is none.
  double value(std::string_view column);

  /// A moment of this simulation: all that changes as it goes, in memory of its own.
  class Moment;
  std::shared_ptr<const Moment> save() const;
  /// Goes back to a moment of this simulation. From there it goes on as it did before, up to the tolerance of Newton's
  /// iteration, since the factor at hand is made anew. Rows and pictures that the recorder was given are not taken
  /// back.
  void restore(const Moment& moment);

  /// Judges what was simulated: what `simulate` returns. Hands it to the recorder and ends the simulation.
  const records::Summary& finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bough::run
