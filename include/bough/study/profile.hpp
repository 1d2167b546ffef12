#pragma once
/// The tree of sub-domains as it runs: sizes, times, critical path, what other numbers of threads and other trees
/// would take.
#include <string>

#include "bough/records/profile.hpp"
#include "bough/run/simulate.hpp"

namespace bough::study {

struct ProfileOptions {
  int threads = 1;            ///< of the run that is looked at
  long steps = 200;           ///< most accepted steps
  long steps_for_speed = 50;  ///< most steps of the runs with other numbers of threads
  int widest_condition =
      120;  ///< conditions are computed of interfaces with at most so many unknowns (dense singular values)
};

/// Runs a scene for some steps with a watched walker, then again with 1, 2, 4 ... threads up to those of the machine.
/// Rows, motion and summary go to `recorder`, bitwise those of simulate() with the same number of steps.
/// Precondition: problems_in(scene) is empty, the solver is hierarchical (cannot_profile is empty).
records::Profile profile(const scene::Scene& scene, const ProfileOptions& options, records::Recorder& recorder,
                         const run::ProgressCallback& progress = {});

/// Why a scene has no tree to profile; empty when it has.
std::string cannot_profile(const scene::Scene& scene);

}  // namespace bough::study
