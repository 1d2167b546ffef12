#include "accuracy.hpp"

#include <algorithm>
#include <cmath>

#include "bough/io/number_text.hpp"
#include "bough/records/errors.hpp"
#include "bough/records/no_recorder.hpp"
#include "bough/run/estimate.hpp"
#include "bough/run/memory_run.hpp"
#include "bough/scene/analysis_kinds.hpp"
#include "error_doubts.hpp"
#include "twin_scenes.hpp"
#include "twins.hpp"

namespace bough::run {

using records::ErrorOf;
using records::ErrorPart;
using records::ErrorState;
using records::RunStatus;

namespace {

constexpr int most_trials = 12;
/// Trials whose errors have no order: shorter steps will not help, or cost too much.
constexpr int most_unresolved = 3;
constexpr double margin = 0.7;        ///< part of the allowed error that is aimed at: predictions are that good
constexpr double foreseen = 1.0 / 8;  ///< shortest step, over that of a trial, which its errors foretell
constexpr double shortest = 1.0 / 16;
constexpr double most_steps = 1e7;
constexpr double most_elements = 1e5;
constexpr double rows = 1000.0;  ///< of the history, about, where the scene has one of every step

std::string number(double value) { return io::rounded_text(value, 3); }

/// By how much steps have to shrink, or numbers of elements to grow, for one kind of error.
struct Need {
  bool is_known = true;  ///< errors are those of the theory, or small enough whatever they are
  bool is_left = false;  ///< the largest is what tolerance and round-off leave open
  double factor = 1.0;   ///< above 1 in the direction of smaller errors; 1: they are small enough
  double share = 0.0;    ///< largest error over what is allowed
  std::string of;        ///< the column or measure of which that is

  bool is_met() const { return is_known && share <= 1.0; }
};

class Judge {
 public:
  Judge(const scene::Accuracy& asked, bool has_mesh) : asked_(asked), part_(has_mesh ? 0.5 : 1.0) {}

  Need need(const records::MeasuredErrors& errors, ErrorPart ErrorOf::*kind) const {
    Need need;
    for (const ErrorOf& e : errors.columns)
      if (is_wanted(e.name)) see(need, e, e.*kind, asked_.absolute + asked_.relative * e.range);
    for (const ErrorOf& e : errors.measures)
      if (!asked_.of.empty() && is_wanted(e.name))
        see(need, e, e.*kind, asked_.absolute + asked_.relative * std::abs(e.value));
    return need;
  }

 private:
  bool is_wanted(const std::string& name) const {
    if (asked_.of.empty()) return true;
    const std::string sensor = name.substr(0, name.rfind('.'));
    return std::any_of(asked_.of.begin(), asked_.of.end(),
                       [&](const std::string& of) { return of == name || of == sensor; });
  }
  /// allowed: by all kinds of errors together.
  void see(Need& need, const ErrorOf& e, const ErrorPart& part, double allowed) const {
    constexpr double noise = 100.0;  // roundings in the range of what is a number
    allowed *= part_;
    // A column that is zero but for round-off has a range of that size.
    const bool is_noise = part.state == ErrorState::round_off && e.range <= noise * part.largest && e.range > 0.0;
    if (part.state == ErrorState::not_measured || !(allowed > 0.0) || is_noise) return;
    const bool is_known = part.is_known() || agrees(part, allowed);
    const double share = part.largest / allowed;
    if (share > need.share || (need.is_known && !is_known)) {
      need.of = e.name;
      need.is_left = part.state == ErrorState::round_off;
    }
    need.share = std::max(need.share, share);
    need.is_known = need.is_known && is_known;
    if (part.is_known() && part.state != ErrorState::round_off && part.theoretical_order > 0.0 && share > 1.0)
      need.factor = std::max(need.factor, std::pow(share / margin, 1.0 / part.theoretical_order));
  }

  const scene::Accuracy& asked_;
  double part_;  ///< of what is allowed, for each kind of error
};

class Search {
 public:
  Search(const scene::Scene& scene, const SimulateOptions& options, records::Recorder& recorder,
         const ProgressCallback& progress)
      : asked_(*scene.analysis.accuracy),
        options_(options),
        recorder_(recorder),
        progress_(progress),
        given_(scene),
        is_in_time_(scene::type_of(scene.analysis.kind).integrates),
        has_mesh_(asked_.mesh && !scene.beams.empty()),
        judge_(asked_, has_mesh_ && is_in_time_) {
    given_.analysis.accuracy.reset();
    given_.analysis.errors = {.time = is_in_time_ || !has_mesh_, .mesh = has_mesh_};
    step_ = scene.analysis.step_size;
  }

  records::Summary run() {
    std::string cause;
    for (int trial = 0; trial < most_trials && cause.empty(); ++trial) {
      const records::Summary found = try_out();
      if (found.status == RunStatus::interrupted) {
        recorder_.end(found);
        return found;
      }
      if (!choose(found)) break;
      cause = out_of_reach();
    }
    return cause.empty() ? make_run() : fail(cause);
  }

 private:
  scene::Scene scene_now(bool is_trial) const {
    scene::Scene scene = elements_ == 1.0 ? given_ : with_elements(given_, elements_);
    if (is_in_time_) {
      constexpr double whole = 4.0;  // the longest twin's steps divide the run
      const double end = scene.analysis.end_time;
      const double steps = whole * std::ceil(end / (whole * step_) * (1.0 - 1e-12));
      scene.analysis.step_size = end / steps;
      if (scene.output.stride == 1) scene.output.stride = std::max(1, static_cast<int>(steps / rows));
    }
    if (is_trial) {
      scene.output.motion = false;
      scene.output.checkpoint = 0.0;
    }
    return scene;
  }

  records::Summary try_out() {
    SimulateOptions options;
    options.threads = options_.threads;
    options.from = options_.from;
    records::NoRecorder nobody;
    const scene::Scene scene = scene_now(true);
    return simulate_with_twins(scene, options, nobody, progress_);
  }

  /// The next trial by what the last one tells. False: what is chosen is foretold to meet the accuracy.
  bool choose(const records::Summary& found) {
    constexpr double unknown = 4.0;  // by which steps shrink while their errors have no order
    if (!found.errors) {             // it failed
      step_ /= unknown;
      return is_in_time_;
    }
    const Need time = judge_.need(*found.errors, &ErrorOf::time), mesh = judge_.need(*found.errors, &ErrorOf::mesh);
    bool goes_on = false;
    if (!time.is_known || !mesh.is_known) ++unresolved_;
    if (unresolved_ > most_unresolved) return false;
    if (is_in_time_ && !time.is_met()) {
      const double shrink = time.is_known ? 1.0 / time.factor : 1.0 / unknown;
      // A trial nearer to what is needed foretells it better.
      goes_on = !time.is_known || shrink < foreseen;
      foretold_ = time.is_known ? shrink * step_ : 0.0;
      step_ *= std::max(goes_on && time.is_known ? 2.0 * shrink : shrink, shortest);
    }
    if (has_mesh_ && !mesh.is_met()) {
      constexpr double most_at_once = 4.0;
      const double grow = mesh.is_known ? std::exp2(std::ceil(std::log2(mesh.factor) - 1e-9)) : 2.0;
      goes_on = goes_on || !mesh.is_known || grow > most_at_once;
      elements_ *= std::min(grow, most_at_once);
    }
    return goes_on;
  }

  std::string out_of_reach() const {
    const scene::Scene next = scene_now(true);
    double elements = 0.0;
    for (const scene::Beam& b : next.beams) elements += b.elements;
    const double step = foretold_ > 0.0 ? foretold_ : step_;
    if (is_in_time_ && next.analysis.end_time / step > most_steps)
      return "steps of " + number(step) + " s, " + number(next.analysis.end_time / step) + " of them";
    if (has_mesh_ && elements > most_elements) return number(elements) + " elements";
    const std::string refused = refusal_of(next);
    return refused.empty() ? "" : "a run that is refused:" + refused;
  }

  std::string chosen() const {
    std::string text;
    if (is_in_time_) {
      const double step = scene_now(false).analysis.step_size;
      text = std::to_string(std::lround(given_.analysis.end_time / step)) + " steps of " + number(step) + " s";
    }
    if (has_mesh_ && elements_ != 1.0)
      text += (text.empty() ? "" : " and ") + number(elements_) + " times as many elements";
    return text.empty() ? "the mesh of the scene" : text;
  }

  records::Summary fail(const std::string& takes) {
    records::Summary summary;
    summary.scene = given_.name;
    summary.status = RunStatus::failed;
    summary.cause =
        "the accuracy that is asked for would take " + takes + ": ask for less, or for that of some sensors";
    recorder_.end(summary);
    return summary;
  }

  records::Summary make_run() {
    SimulateOptions options = options_;
    options.checks_estimate = false;
    const scene::Scene scene = scene_now(false);
    return simulate_with_twins(scene, options, recorder_, progress_,
                               [this](records::Summary& summary) { judge(summary); });
  }

  void judge(records::Summary& summary) const {
    if (!summary.errors) return;
    bool is_met = true;
    std::string text;
    const auto add = [&](const Need& need, const std::string& of) {
      is_met = is_met && need.is_met();
      if (need.of.empty()) return;
      text += (text.empty() ? "" : ", ") + of + " of '" + need.of +
              "': " + (!need.is_known ? "is not resolved" : number(need.share) + " of what is allowed") +
              (need.is_left && need.share > 1.0
                   ? ", which tolerance and round-off leave open: take a smaller /analysis/tolerance"
                   : "");
    };
    add(judge_.need(*summary.errors, &ErrorOf::time), "the error in time");
    if (has_mesh_) add(judge_.need(*summary.errors, &ErrorOf::mesh), "the error of the mesh");
    if (is_met)
      summary.notes.push_back("the accuracy that was asked for is met by " + chosen() +
                              (text.empty() ? "" : ": " + text));
    else
      summary.doubts.push_back({"accuracy", "the accuracy that was asked for is not met by " + chosen() + ": " + text +
                                                (asked_.of.empty() ? "; \"of\" in /analysis/accuracy names those that "
                                                                     "have to meet it, where not all do"
                                                                   : "")});
  }

  const scene::Accuracy& asked_;
  const SimulateOptions& options_;
  records::Recorder& recorder_;
  const ProgressCallback& progress_;
  scene::Scene given_;
  bool is_in_time_, has_mesh_;
  Judge judge_;
  double step_, elements_ = 1.0;  ///< step size [s] and factor of all numbers of elements of the next trial
  int unresolved_ = 0;            ///< trials so far whose errors have no order
  double foretold_ = 0.0;         ///< the step that the accuracy takes [s]; 0: not known
};

}  // namespace

records::Summary simulate_to_accuracy(const scene::Scene& scene, const SimulateOptions& options,
                                      records::Recorder& recorder, const ProgressCallback& progress) {
  return Search(scene, options, recorder, progress).run();
}

}  // namespace bough::run
