/// Inverse dynamics: drives prescribe the whole motion, and what drives it is evaluated.
#include <algorithm>
#include <cmath>
#include <memory>

#include "analysis.hpp"
#include "bough/io/number_text.hpp"
#include "bough/plan/undriven.hpp"
#include "bough/step/advance.hpp"
#include "bough/step/linearisation.hpp"

namespace bough::run {

namespace {

/// Evaluates, at times 0, h, 2 h, ... and at those of figures, the state that the constraints alone determine:
///   positions Phi(q, t) = 0,  velocities G v = -Phi_t,  accelerations G a = -Phi''|_{a = 0},
///   efforts and reactions G^T lambda = forces - M a,  lambda of least norm where rows depend on each other.
/// No time is integrated: nothing at one time depends on another but the branch on which loops are closed and the turns
/// of joints. To stay on them, the way between two times is divided where parts move far; that adds no error.
class InverseDynamics final : public Analysis {
 public:
  explicit InverseDynamics(const Parts& parts)
      : Analysis(parts),
        intervals_(std::max(1L, static_cast<long>(std::ceil(end() / parts.scene.analysis.step_size - slack)))),
        stops_(stops_between(0.0, end())) {}
  std::unique_ptr<Analysis> clone() const override { return std::make_unique<InverseDynamics>(*this); }

  bool begin() override {
    if (const auto undriven = plan::undriven_motions(scene_, plan_); !undriven.empty()) return fail(one_text(undriven));
    const plan::IdleMotions idle = plan::idle_motions(scene_, plan_);
    if (idle.count > 0) note(idle.note);
    allowed_ = idle.count;
    if (!close(state_, state_.time, scene_.analysis.step_size)) return fail(cause_);
    if (moved_ > slack)
      note("the start was moved by up to " + io::rounded_text(moved_, 3) +
           " (relative) to where drives and joints ask for");
    return accept(0.0);
  }
  bool take_step() override {
    const double from = state_.time, to = next_time();
    if (!(may_try(to) && go_to(to) && accept(to - from))) return false;
    report_progress(reached(), end());
    return true;
  }
  void checkpoint(records::Archive& archive) override {
    Analysis::checkpoint(archive);
    archive(allowed_, has_begun_, next_);
  }
  bool is_done() const override { return !(state_.time < end()); }
  bool ends_in_correction() const override { return false; }
  void add_notes() override {
    if (account().dependent_rows() > 0)
      note(
          "of the reactions and efforts of drives that are not unique, those of least norm are given, each multiplier "
          "in units of the norm of its constraint row");
  }

 private:
  static constexpr double slack = 1e-9;          ///< relative differences that are round-off of times, or no motion
  static constexpr double far_correction = 0.3;  ///< of relative motions [-, rad]: the branch might be another one
  static step::StepReport reached() {
    step::StepReport report;
    report.converged = true;
    return report;
  }

  /// All texts: the first whole, of the others what follows the words that all begin with.
  static std::string one_text(const std::vector<std::string>& texts) {
    constexpr std::size_t most = 12;
    const std::string common = ", but ";
    std::string text = texts.front();
    for (std::size_t i = 1; i < std::min(most, texts.size()); ++i) {
      const std::size_t at = texts[i].find(common);
      text += "; and " + texts[i].substr(at == std::string::npos ? 0 : at + common.size());
    }
    return texts.size() > most ? text + "; and " + std::to_string(texts.size() - most) + " more" : text;
  }

  double end() const { return scene_.analysis.end_time; }

  double next_time() {
    const double h = scene_.analysis.step_size, least = slack * h;
    while (next_ < intervals_ && static_cast<double>(next_) * h <= state_.time + least) ++next_;
    const double regular = next_ < intervals_ ? static_cast<double>(next_) * h : end();
    const double stop = *std::find_if(stops_.begin(), stops_.end(), [&](double t) { return t > state_.time; });
    return stop < regular + least ? stop : regular;
  }

  /// Takes the state to a later time, in 2^k parts where one does not do.
  bool go_to(double to) {
    const double from = state_.time;
    int level = 0;
    for (long part = 0; part < 1L << level;) {
      const double parts = static_cast<double>(1L << level);
      const double target = part + 1 == 1L << level ? to : from + (to - from) * static_cast<double>(part + 1) / parts;
      tried_ = state_;
      predict(target - state_.time);
      if (close(state_, target, target - tried_.time) && is_near(target)) {
        if (!plan_.joints.empty()) step::accept_turns(system_, state_);
        ++part;
        continue;
      }
      state_ = tried_;
      part *= 2;
      if (++level > options_.max_cuts) return fail(cause_);
    }
    return true;
  }

  /// Moves all nodes along the motion that they have: H <- H exp(h v + h^2/2 dv/dt).
  void predict(double h) {
    increments_.assign(system_.places().size(), 0.0);
    state_.visit([&](const auto& nodes) {
      for (std::size_t n = 0; n < nodes.motion.size(); ++n) {
        const auto& node = nodes.motion[n];
        system_.places().set_node_part(increments_.data(), static_cast<int>(n),
                                       std::decay_t<decltype(node.v)>(h * node.v + (0.5 * h * h) * node.a));
      }
    });
    (void)system_.corrections().apply(state_, increments_.data());
  }

  /// Makes the state that of a time: its left limit, but at the start.
  bool close(step::State& state, double time, double size) {
    state.time = time;
    // Motions without effect get the least velocities with which the constraints hold, whatever they were before.
    if (allowed_ > 0) step::set_at_rest(state);
    const step::StartReport report =
        step::make_consistent_on(system_, state, true, size, time > 0.0 ? laws::Side::left : laws::Side::right);
    cause_ = report.cause;
    moved_ = report.position_correction;
    return report.ok;
  }

  bool is_near(double time) {
    if (const auto flipped = step::check_shape(system_, state_))
      cause_ = flipped->text;
    else if (moved_ > far_correction)
      cause_ = "drives move parts by " + io::rounded_text(moved_, 3) + " (relative) at once at time " +
               io::rounded_text(time, 6) + ": their laws jump there, or loops change their branch";
    return cause_.empty();
  }

  /// Records the present state, if it follows from the constraints alone.
  bool accept(double interval) {
    const step::UnknownPlaces& places = system_.places();
    const auto rows = static_cast<long>(places.multipliers().size());
    const long of_nodes = static_cast<long>(places.size() - places.signals().size()) - rows;
    const long left = of_nodes - (rows - dependent_rows());
    if (!has_begun_) allowed_ = std::min(allowed_, left);  // reduced models have no motions out of their plane
    has_begun_ = true;
    if (left > allowed_)
      return fail("at time " + io::rounded_text(state_.time, 6) + " drives and joints leave " +
                  std::to_string(left - allowed_) +
                  " motion(s) free: the mechanism passes a singular position there, from which it can go on in more "
                  "than one way");
    if (interval > 0.0) account().count(reached(), state_);
    if (knows_rank())
      account().watch_dependent_rows(state_.time);
    else
      account().watch_dependent_rows(state_.time, of_rank_->solver());
    last_step_ = interval;
    record(0, is_done());
    if (is_done()) recording_.end_stretch(state_);
    return true;
  }

  bool knows_rank() const { return system_.linear().solver().last_status().deficiency >= 0; }

  /// Number of constraint rows that depend on others. A solver that regularises singular matrices does not know it:
  /// then the same matrix is factored in the form that does.
  int dependent_rows() {
    if (knows_rank()) return system_.linear().solver().last_status().deficiency;
    if (!of_rank_) of_rank_ = std::make_shared<step::Linearisation>(system_);
    of_rank_->take_tangents();
    return of_rank_->factor({}, solve::Symmetry::general).deficiency;
  }

  long allowed_ = 0;  ///< number of motions without effect that drives leave free
  bool has_begun_ = false;
  std::shared_ptr<step::Linearisation> of_rank_;  ///< made where it is needed; its contents are scratch
  long intervals_, next_ = 1;                     ///< of the step size up to the end, and the end of the next one
  std::vector<double> stops_;
  step::State tried_;
  std::vector<double> increments_;
  std::string cause_;
  double moved_ = 0.0;
};

}  // namespace

std::unique_ptr<Analysis> make_inverse_dynamics(const Parts& parts) { return std::make_unique<InverseDynamics>(parts); }

}  // namespace bough::run
