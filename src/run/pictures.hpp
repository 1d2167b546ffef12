#pragma once
/// Which states of a run are drawn.
#include <optional>
#include <string>

#include "bough/plan/plan.hpp"
#include "bough/records/run.hpp"
#include "bough/scene/scene.hpp"

namespace bough::run {

/// Chooses the pictures of a motion. A stride that the scene gives is kept. Else a run has at most 101 pictures, one in
/// each of equal intervals of time (or load), and so few that motion.bin stays below 120 MB and all files below 200 MB.
class Pictures {
 public:
  /// is_wanted: false: there is none.
  Pictures(const scene::Scene& scene, const plan::Plan& plan, bool is_wanted);

  /// Whether the state at the end of step `row` (0: the start) is drawn.
  bool is_due(long row, double time, bool is_last) const;
  /// Whether `set_size` is to be called before the next picture.
  bool is_first() const { return is_first_; }
  /// Takes the size of the pictures from the first one. Where they are so large that fewer are kept, a note says how
  /// many.
  [[nodiscard]] std::optional<std::string> set_size(const records::MotionFrame& frame,
                                                    const records::MotionParts& parts);
  /// Counts the picture of this time. True: a file for other programs is written of it, too.
  bool take(double time, bool is_last);

 private:
  bool is_passed(double time, int interval) const;

  bool is_wanted_, follows_path_;
  int stride_;  ///< in steps; 0: not given
  double end_;  ///< [s], or load factor
  int most_intervals_ = 100, next_ = 1;
  int others_every_ = 1;  ///< one in so many pictures is written for other programs, too
  int taken_ = 0;
  bool is_first_ = true;
};

}  // namespace bough::run
