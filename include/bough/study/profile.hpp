#pragma once
/// Profile of the tree of sub-domains in a run: sizes, times, critical path, and predictions for other numbers of
/// threads and other trees.
#include <string>

#include "bough/records/profile.hpp"
#include "bough/run/simulate.hpp"

namespace bough::study {

struct ProfileOptions {
  int threads = 1;            ///< threads of the profiled run
  long steps = 200;           ///< most accepted steps
  long steps_for_speed = 50;  ///< most steps of the runs with other numbers of threads
  int widest_condition =
      120;  ///< conditions are computed for interfaces of at most this many unknowns (dense singular values)
};

/// Runs a scene for some steps with a timed walker, then again with 1, 2, 4 ... threads up to those of the machine.
/// Rows, motion and summary are passed to `recorder`; they are bitwise those of simulate() with the same number of
/// steps and without the decision `small`, which would take one thread, and one sub-domain for a small structure with
/// many loops. Precondition: problems_in(scene) is empty. Forms without a tree of sub-domains that walks visit
/// (global, hybrid, monolithic) have no times of visits: those of the step alone are told.
records::Profile profile(const scene::Scene& scene, const ProfileOptions& options, records::Recorder& recorder,
                         const run::ProgressCallback& progress = {});

}  // namespace bough::study
