#pragma once
/// Stability in motions that a run leaves out or cannot see: out of its plane or line, and vibrations under loads that
/// have no potential.
#include <memory>
#include <optional>
#include <string>

#include "bough/step/stability.hpp"

namespace bough::run {

/// The scene in all motions, where its plan has left some out: those out of a plane, or across a line.
class HiddenMotions {
 public:
  explicit HiddenMotions(const scene::Scene& scene) : scene_(scene) {}
  HiddenMotions(const HiddenMotions& other) : scene_(other.scene_) {}
  /// Whether a plan leaves motions out.
  static bool are_in(const plan::Plan& plan);
  /// "out of its plane" or "sideways".
  static std::string where(const plan::Plan& plan);

  struct Look {
    bool is_known = false;
    std::string mode;  ///< in which it is unstable; empty: in none that is left out
  };
  /// Evaluates a state of a run with this plan in all motions. unstable: directions among those of the plan in which it
  /// is unstable; none: they are counted. The first look makes a plan.
  Look look(const plan::Plan& plan, const step::State& state, std::optional<int> unstable);

 private:
  struct Model {
    plan::Plan plan;
    std::unique_ptr<step::System> system;
  };
  std::optional<int> count_own(const plan::Plan& plan, const step::State& state);

  const scene::Scene& scene_;
  std::unique_ptr<Model> whole_;
  std::unique_ptr<step::System> own_;
};

/// What is known of vibrations about the last equilibrium of statics, whose loads have no potential.
struct FlutterLook {
  bool is_known = false;
  std::string text;     ///< how they grow; empty: they do not
  std::string why_not;  ///< it is not known
};
FlutterLook look_for_flutter(const scene::Scene& scene, const plan::Plan& plan, const step::State& state);

}  // namespace bough::run
