#pragma once
/// Measures which solver options run a scene fastest on this machine.
#include <functional>
#include <string>
#include <vector>

#include "bough/scene/scene.hpp"

namespace bough::study {

struct TuneOptions {
  int threads = 1;
  long steps = 20;        ///< of each short run; the first step is not timed if there are others
  double seconds = 60.0;  ///< no round starts later than this, except for the first three
  int rounds = 9;         ///< most rounds
};

struct TuneCandidate {
  scene::Solver solver;
  bool is_present = false;  ///< the scene's own options
  int num_subdomains = 0;   ///< 0: there is no tree
  int num_levels = 0;
  std::vector<double> seconds = {};  ///< seconds per step, by round
  double median = 0.0;               ///< of these [s]
  double low = 0.0, high = 0.0;      ///< smallest and largest [s]
  std::string failure = {};          ///< why it was excluded; empty: it was not
};

struct TuneResult {
  std::vector<TuneCandidate> candidates;  ///< by median, excluded ones last
  int rounds = 0;
  std::size_t present = 0;  ///< index of the scene's own options
  std::size_t best =
      0;  ///< index of the best options: the present ones, unless others win three of four rounds and by 2 % in the
          ///< median
  double gain = 0.0;  ///< 1 - median ratio of best to present over the rounds [-]
};

/// Runs all candidates in turn, round after round, for a few steps each; candidates that take more than 2.5 times as
/// long as the fastest are not run again. Candidates are the scene's own options, trees of other leaf sizes and depths,
/// without tasks, and the monolithic libraries that are available. `progress(done, all)` is called after each run and
/// returns false to stop early. Precondition: problems_in(scene) is empty.
TuneResult tune(const scene::Scene& scene, const TuneOptions& options,
                const std::function<bool(int done, int all)>& progress = {});

/// The block `solver` of a scene as one JSON object on one line, without members that the program chooses.
std::string solver_block(const scene::Solver& solver);

}  // namespace bough::study
