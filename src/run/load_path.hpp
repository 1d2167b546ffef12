#pragma once
/// Statics by arc length along a path of equilibria.
#include <optional>
#include <string>
#include <vector>

#include "bough/step/arc_length.hpp"
#include "path_search.hpp"
#include "statics.hpp"

namespace bough::run {

/// Follows the path in steps whose length adapts to the number of iterations. Ends where the load factor passes its
/// final value, or at a given limit point.
class LoadPath final : public Statics {
 public:
  explicit LoadPath(const Parts& parts) : Statics(parts) {}
  std::unique_ptr<Analysis> clone() const override { return std::make_unique<LoadPath>(*this); }
  bool begin() override;
  bool take_step() override;
  bool is_done() const override { return is_done_; }
  void come_back() override;
  void checkpoint(records::Archive& archive) override {
    Statics::checkpoint(archive);
    archive.present(path_, [this] { path_.emplace(system_, options_); });
    archive(length_, is_done_);
  }

 private:
  /// A step along the path with the limit point, the end of the run and the bifurcations found in it.
  struct Step {
    step::State end;
    std::optional<PathPoint> limit, stop;  ///< limit point of the load; end of the run
    bool stops_after_limit = false;
    std::vector<records::Bifurcation> bifurcations;
    std::optional<step::StabilityLook> look;  ///< stability at its end; none if another equilibrium was examined since
    const step::State& last() const { return stop ? stop->state : end; }
  };
  bool try_step(Step& step, step::StepReport& report, int& cuts);
  std::string look_at_step(double length, bool is_last_try, Step& step);
  void locate_limit(PathPlace from, PathPlace to, double noise, Step& step);
  bool passes_end(double from, double to, std::size_t limit_points) const;
  std::string look_at_stability(double length, bool is_last_try, Step& step);
  std::string find_bifurcation(PathPlace& from, PathPlace to, int unstable_there, Step& step);
  bool look_within(PathPlace from, PathPlace to);
  PathPoint find_end(PathPlace from, PathPlace to, const step::State& beyond);
  void accept_bifurcation(records::Bifurcation&& bifurcation);
  void accept_limit_point(const PathPoint& limit, bool is_maximum, int iterations);
  PathSearch make_search() { return {*path_, start_, direction_, account().newton_iterations()}; }

  std::optional<step::ArcLengthPath> path_;
  double length_ = 0.0;                     ///< length of the next step
  step::State start_;                       ///< state at the start of the present step
  step::ArcLengthPath::Vectors direction_;  ///< direction of the path there
  step::StabilityLook start_look_;          ///< stability there
  bool is_done_ = false;
};

}  // namespace bough::run
