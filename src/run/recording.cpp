#include "recording.hpp"

#include <algorithm>
#include <cmath>

#include "bough/io/number_text.hpp"
#include "bough/plan/history_header.hpp"
#include "bough/results/observe.hpp"
#include "bough/scene/analysis_kinds.hpp"
#include "effective_options.hpp"

namespace bough::run {

using records::RunStatus;

namespace {

/// The expected figures of the scene, followed by its measures that are taken in the same way.
std::vector<scene::Expected> figures_asked_for(const scene::Scene& scene) {
  std::vector<scene::Expected> figures = scene.expected;
  for (const scene::Measure& m : scene.measures) {
    if (!Measures::is_figure(m)) continue;
    scene::Expected figure;
    figure.quantity = m.quantity;
    figure.figure = static_cast<scene::FigureKind>(m.kind);
    figure.time = m.time;
    figure.level = m.level;
    figures.push_back(std::move(figure));
  }
  return figures;
}

/// Compares a measure with its expected value. `how` holds how it was taken and whether its time was reached.
records::ExpectedResult held_against(const scene::Expected& given, const records::MeasureResult& measured,
                                     records::ExpectedResult how) {
  how.name = measured.name;
  how.value = measured.value.value_or(0.0);
  how.reference = given.value;
  how.tolerance = given.allowed();
  how.source = given.source;
  how.has_value = measured.value.has_value();
  how.holds = how.reached && measured.value && std::abs(how.value - how.reference) <= how.tolerance;
  return how;
}

/// Whether work and energies are followed in every step: if checks are made, and for the variational integrator, whose
/// runs are judged by their energy while they proceed.
bool follows_energy(const scene::Scene& scene, const plan::Plan& plan) {
  if (plan.is_dynamic && !scene::type_of(scene.analysis.kind).integrates) return false;
  return scene.output.checks || (plan.is_dynamic && scene.analysis.integrator == scene::Integrator::variational);
}

}  // namespace

Recording::Recording(const scene::Scene& scene, const SimulateOptions& options, const step::StepOptions& step_options,
                     step::System& system, records::Recorder& recorder)
    : scene_(scene),
      system_(system),
      recorder_(recorder),
      start_(options.from ? start_time(*options.from) : 0.0),
      account_(system),
      conservation_(system, follows_energy(scene, system.plan())),
      pictures_(scene, system.plan(), options.want_motion || scene.output.motion),
      asked_(std::make_shared<const std::vector<scene::Expected>>(figures_asked_for(scene))),
      figures_(scene, *asked_, system.plan(), plan::make_header(system.plan()), options.stops, options.sample),
      measures_(scene, plan::make_header(system.plan())),
      springs_(system.plan()),
      far_(system.plan()) {
  const plan::Plan& plan = system.plan();
  records::Summary& s = summary();
  s.status = RunStatus::failed;
  s.scene = scene.name;
  s.title = scene.title;
  s.options = effective_options(scene, step_options);
  s.header = plan::make_header(plan);
  s.notes = plan.notes;
  s.checks.evaluated = scene.output.checks;
  const bool integrates = scene::type_of(scene.analysis.kind).integrates;
  s.follows_path = !plan.is_dynamic && step_options.arc_length.has_value();
  const bool tells_errors = integrates && step_options.integrator == scene::Integrator::generalized_alpha;
  if (tells_errors && scene.output.checks) error_watch_.emplace(plan);
  // In a reduced model the nodes that sensors read are converted to space, and all of them for anything but motion.
  if (!plan.is_on<motion::Se3>() && std::all_of(plan.sensors.begin(), plan.sensors.end(),
                                                [](const auto& s) { return results::shows_motion(s.sensor.kind); }))
    motion_sensors_.emplace(plan);
}

bool Recording::is_due(long row, bool is_last) const { return row % std::max(1, scene_.output.stride) == 0 || is_last; }

void Recording::record(const step::State& state, double step_size, int iterations, bool is_last) {
  const step::PhaseTimer timer{system_.clock(), summary().times.output};
  const long row = rows_++;
  summary().step_size = std::max(summary().step_size, step_size);
  const bool due = is_due(row, is_last);
  if ((due || !measures_.empty()) && !system_.plan().sensors.empty()) {
    (void)eval_sensors(state);
    if (due && error_watch_) error_watch_->see(values_);
    if (due) far_.see(values_);
    if (!measures_.empty()) measures_.add(state.time, values_);
  }
  if (due) springs_.look(system_, state);
  if (due && scene_.output.checks) conservation_.check(state, step_size, summary().checks, gate_, error_watch());
  if (due) {
    row_.time = state.time;
    row_.step_size = row == 0 ? 0.0 : step_size;
    row_.iterations = iterations;
    row_.values = values_;
    gate_.look_at(summary().header, row_);
    recorder_.row(row_);
  }
  if (pictures_.is_wanted() && turns_.has_begun()) turns_.look(system_, state);
  if (pictures_.is_due(row, state.time, turns_.turn(), is_last)) draw(state, is_last);
  add_figures(state);
}

/// To be called with every picture: before the first one the recorder is told what does not change.
void Recording::begin_picture(const records::MotionFrame& frame) {
  gate_.look_at(frame);
  if (!pictures_.is_first()) return;
  const records::MotionParts parts = results::make_parts(scene_, system_);
  if (const auto fewer = pictures_.set_size(frame, parts, recorder_.keeps_states() ? system_.plan().nodes.size() : 0))
    account_.note(*fewer);
  recorder_.parts(parts);
}

void Recording::draw_shape(const step::State& state) {
  if (!pictures_.is_wanted()) return;
  const step::PhaseTimer timer{system_.clock(), summary().times.output};
  const records::MotionFrame frame = results::eval_motion(system_, state);
  begin_picture(frame);
  recorder_.motion(frame);
}

void Recording::draw(const step::State& state, bool is_last) {
  records::MotionFrame frame = results::eval_motion(system_, state);
  begin_picture(frame);
  frame.for_others = pictures_.take(state.time, is_last);
  frame.turn = turns_.turn();
  if (frame.turn > records::largest_turn && !is_turn_told_) {
    is_turn_told_ = true;
    account_.note(
        "before time " + io::rounded_text(state.time, 4) + " a part turns by more than " +
        io::rounded_text(records::largest_turn, 2) +
        " rad from one picture to the next: pages show the nearer of the two there, and no motion between them; "
        "output.motion_stride keeps more pictures, and smaller steps tell more of them apart");
  }
  turns_.begin(system_, state);
  recorder_.motion(frame);
  if (frame.for_others) hand_out(state);
}

records::StoredState Recording::named(const step::State& state) {
  if (!parts_) parts_.emplace(scene_, system_.plan());
  return parts_->store(system_, state);
}

void Recording::hand_out(const step::State& state) {
  if (!recorder_.keeps_states() || rows_ == 0 || handed_out_ == state.time) return;
  handed_out_ = state.time;
  recorder_.state(named(state));
}

void Recording::checkpoint(records::Archive& archive) {
  archive(account_, conservation_, gate_, pictures_, turns_, is_turn_told_, figures_, measures_, springs_, far_,
          error_watch_, handed_out_, values_, row_, rows_);
}

void Recording::come_back() {
  if (pictures_.is_wanted() && !pictures_.is_first()) recorder_.parts(results::make_parts(scene_, system_));
}

const std::vector<double>& Recording::eval_sensors(const step::State& state) {
  if (motion_sensors_) {
    motion_sensors_->see(system_.plan(), state);
    motion_sensors_->eval(system_, values_);
  } else {
    results::eval_sensors(system_, state, conservation_.energies(), values_);
  }
  return values_;
}

void Recording::take_figures() {
  records::Summary& s = summary();
  s.expected = figures_.results(s);
  for (std::size_t k = 0; k < s.expected.size(); ++k)
    if (!is_time_passed((*asked_)[k].time)) s.expected[k].reached = s.expected[k].holds = false;
  const std::vector<records::MeasureResult> of_whole_run = measures_.results();
  s.measures.clear();
  std::vector<records::ExpectedResult> of_measures;
  std::size_t next_figure = scene_.expected.size(), next_measure = 0;
  for (const scene::Measure& m : scene_.measures) {
    records::MeasureResult measured{m.name, std::nullopt};
    records::ExpectedResult how;
    if (Measures::is_figure(m)) {
      how = s.expected[next_figure++];
      if (how.reached && how.has_value && std::isfinite(how.value)) measured.value = how.value;
    } else if (m.is_of_measures) {
      measured.value = value_of_measures(m, s.measures);
      how.taken = "from other measures";
      how.reached = true;
    } else {
      measured = of_whole_run[next_measure++];
      how.taken = "from the ends of all accepted steps";
      how.reached = is_time_passed(m.time);
    }
    if (s.status != RunStatus::ok) measured.value.reset();  // an incomplete run has no measures
    if (m.expected) of_measures.push_back(held_against(*m.expected, measured, std::move(how)));
    s.measures.push_back(std::move(measured));
  }
  s.expected.resize(scene_.expected.size());
  s.expected.insert(s.expected.end(), of_measures.begin(), of_measures.end());
}

bool Recording::is_time_passed(const std::optional<double>& time) const {
  constexpr double round_off = 1e-12;
  return !time || !system_.plan().is_dynamic ||
         (*time >= start_ * (1.0 - round_off) && *time <= scene_.analysis.end_time * (1.0 + round_off));
}

}  // namespace bough::run
