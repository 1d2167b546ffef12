#include "bough/run/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>

#include "analysis.hpp"
#include "bough/records/no_recorder.hpp"
#include "bough/scene/linear_inputs.hpp"
#include "bough/scene/nearest_name.hpp"
#include "bough/schedule/threads.hpp"
#include "judgement.hpp"

namespace bough::run {

using records::RunStatus;

namespace {

int threads_for(const scene::Scene& scene, const plan::Plan& plan, int asked) {
  return scene.solver.tasks && !plan.took("small") ? std::max(1, asked) : 1;
}

/// "; did you mean 'tip.x'? There are 'tip.x', 'tip.y', 'tip.z' and 4 more"
std::string near(std::string_view name, const std::vector<std::string>& known) {
  constexpr std::size_t most = 12;
  const std::string nearest = scene::nearest_name(name, known);
  std::string text = nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
  if (known.empty()) return "; there is none";
  for (std::size_t i = 0; i < std::min(most, known.size()); ++i)
    text += (i > 0 ? ", '" : nearest.empty() ? "; there are '" : " There are '") + known[i] + "'";
  return known.size() > most ? text + " and " + std::to_string(known.size() - most) + " more" : text;
}

step::StepOptions options_for(const scene::Scene& scene, const plan::Plan& plan) {
  step::StepOptions options = step::make_step_options(scene.analysis);
  options.reuse_factors = plan.took("reuse");
  return options;
}

}  // namespace

struct Simulation::Impl {
  enum class Stage { made, going, ended, finished };

  Impl(const scene::Scene& given, SimulateOptions given_options, records::Recorder* given_recorder,
       ProgressCallback given_progress)
      : asked(std::move(given_options)),
        progress(std::move(given_progress)),
        with_inputs(given.analysis.linear.inputs.empty() ? std::nullopt : std::optional(scene::with_inputs(given))),
        scene(with_inputs ? *with_inputs : given),
        recorder(given_recorder != nullptr ? *given_recorder : no_recorder),
        plan(plan::make_plan(scene)),
        options(options_for(scene, plan)),
        threads(threads_for(given, plan, asked.threads)),
        system(plan, given.solver, asked.wrap_walker ? asked.wrap_walker(threads.walker()) : threads.walker()),
        state(step::make_initial_state(plan)) {
    if (recorder.keeps_checkpoints()) system.remember();
    recording.emplace(scene, asked, options, system, recorder);
    recording->summary().threads = threads.count();
    recording->summary().times.prepare =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - made_at).count();
    analysis = make_analysis({scene, options, plan, system, state, *recording, asked, progress});
  }

  bool start() {
    if (stage != Stage::made) return stage == Stage::going;
    if (const std::string kept = recorder.resume(recording->summary().header); !kept.empty()) {
      records::Archive archive(kept);
      checkpoint(archive);
      archive.require_end();
      stage = Stage::going;
      return true;
    }
    recorder.begin(recording->summary().header);
    if (const auto unknown = results::unknown_subdomain(system)) {
      (void)recording->account().fail(*unknown);
      stage = Stage::ended;
      return false;
    }
    stage = analysis->begin() ? Stage::going : Stage::ended;
    return stage == Stage::going;
  }

  bool take_step() {
    if (!start()) return false;
    if (!analysis->take_step()) {
      stage = Stage::ended;
      return false;
    }
    if (analysis->is_done()) {
      stage = Stage::ended;
      recording->summary().status = RunStatus::ok;
      return true;
    }
    const std::string why = recording->account().why_to_stop();
    if (recorder.is_checkpoint_due(state.time, !why.empty())) {
      take_times();
      records::Archive archive;
      checkpoint(archive);
      recorder.checkpoint(archive.bytes());
    }
    if (why.empty()) return true;
    analysis->stop();
    stage = Stage::ended;
    return recording->account().interrupt(why);
  }

  /// All that steps change, but what was recorded. The analysis makes its integrator by the options.
  void checkpoint(records::Archive& archive) {
    records::StoredState named;  // for other scenes, which the rest tells nothing
    if (!archive.is_reading()) named = recording->named(state);
    archive(named, options, state, *recording, *analysis);
    system.checkpoint(archive, [this](long matrices) { return analysis->write_matrices(matrices); });
    if (!archive.is_reading()) return;
    if (const auto trouble = system.set_time(state.time)) throw std::logic_error(trouble->text);
    recording->come_back();
  }

  /// Calls `body` in the scope of the threads and measures its time.
  void together(const std::function<void()>& body) {
    timed_to = std::chrono::steady_clock::now();
    threads.keep_together([&] {
      cpu_timed_to = system.clock().now();
      body();
      take_times();
    });
  }
  void take_times() {
    const auto now = std::chrono::steady_clock::now();
    const double cpu = system.clock().now();
    recording->summary().times.total += std::chrono::duration<double>(now - timed_to).count();
    recording->summary().times.cpu += cpu - cpu_timed_to;
    timed_to = now;
    cpu_timed_to = cpu;
  }

  const std::chrono::steady_clock::time_point made_at = std::chrono::steady_clock::now();
  records::NoRecorder no_recorder;
  const SimulateOptions asked;
  const ProgressCallback progress;
  const std::optional<scene::Scene> with_inputs;  ///< where equations are linearised between inputs and sensors
  const scene::Scene& scene;
  records::Recorder& recorder;
  plan::Plan plan;
  step::StepOptions options;
  schedule::Threads threads;
  step::System system;
  step::State state;
  std::optional<Recording> recording;  ///< always has a value; optional so that restore can replace it
  Cloned<Analysis> analysis;
  Stage stage = Stage::made;
  std::chrono::steady_clock::time_point timed_to = made_at;  ///< times of the summary are those up to here
  double cpu_timed_to = 0.0;                                 ///< [s]
};

class Simulation::Moment {
 public:
  explicit Moment(const Impl& p)
      : options(p.options), state(p.state), recording(*p.recording), analysis(p.analysis), stage(p.stage) {}

  step::StepOptions options;
  step::State state;
  Recording recording;
  Cloned<Analysis> analysis;
  Impl::Stage stage;
};

Simulation::Simulation(const scene::Scene& scene, SimulateOptions options, records::Recorder* recorder,
                       ProgressCallback progress)
    : impl_(std::make_unique<Impl>(scene, std::move(options), recorder, std::move(progress))) {}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

bool Simulation::start() {
  bool is_there = false;
  impl_->together([&] { is_there = impl_->start(); });
  return is_there;
}

bool Simulation::take_step() {
  bool is_taken = false;
  impl_->together([&] { is_taken = impl_->take_step(); });
  return is_taken;
}

bool Simulation::advance_to(double time) {
  constexpr double round_off = 1e-12;
  impl_->together([&] {
    if (!impl_->start()) return;
    while (impl_->state.time < time - round_off * std::max(1.0, std::abs(time)) && impl_->take_step()) {
    }
  });
  return impl_->state.time >= time - round_off * std::max(1.0, std::abs(time));
}

bool Simulation::run() {
  impl_->together([&] {
    while (impl_->take_step()) {
    }
  });
  return impl_->recording->summary().status == RunStatus::ok;
}

bool Simulation::has_ended() const {
  return impl_->stage == Impl::Stage::ended || impl_->stage == Impl::Stage::finished;
}

double Simulation::time() const { return impl_->state.time; }

double Simulation::size() const { return impl_->plan.length_scale; }

const records::HistoryHeader& Simulation::header() const { return impl_->recording->summary().header; }

const std::vector<double>& Simulation::values() {
  if (impl_->stage == Impl::Stage::made) (void)start();
  return impl_->recording->eval_sensors(impl_->state);
}

double Simulation::value(std::string_view column) {
  const std::vector<std::string>& columns = header().columns;
  const auto found = std::find(columns.begin(), columns.end(), column);
  if (found == columns.end())
    throw std::out_of_range("no sensor shows '" + std::string(column) + "'" + near(column, columns));
  return values()[static_cast<std::size_t>(found - columns.begin())];
}

std::string Simulation::set_input(std::string_view signal, double value) {
  Impl& p = *impl_;
  const std::string name(signal);
  const std::vector<plan::SignalPlan>& signals = p.plan.signals;
  const auto input = std::find_if(signals.begin(), signals.end(), [&](const plan::SignalPlan& s) {
    return s.name == name && s.rule == plan::SignalRule::input;
  });
  if (input == signals.end()) {
    std::vector<std::string> inputs;
    for (const plan::SignalPlan& s : signals)
      if (s.rule == plan::SignalRule::input) inputs.push_back(s.name);
    return "no signal of kind \"input\" has the name '" + name + "'" + near(name, inputs);
  }
  if (!std::isfinite(value)) return "the input '" + name + "' has to be finite";
  if (has_ended()) return "the simulation has ended, so that the input '" + name + "' has no effect";
  const auto i = static_cast<std::size_t>(input - signals.begin());
  if (value == p.state.signals.given[i]) return {};
  p.state.signals.given[i] = p.state.signals.value[i] = value;
  p.analysis->jump();
  return {};
}

std::shared_ptr<const Simulation::Moment> Simulation::save() const { return std::make_shared<const Moment>(*impl_); }

void Simulation::restore(const Moment& moment) {
  Impl& p = *impl_;
  p.options = moment.options;
  p.state = moment.state;
  p.recording.emplace(moment.recording);
  p.analysis = moment.analysis;
  p.stage = moment.stage;
  p.system.linear().forget_factor();
  p.system.round_off().met() = {};
  if (p.stage != Impl::Stage::made) p.analysis->come_back();
}

const records::Summary& Simulation::finish() {
  Impl& p = *impl_;
  records::Summary& summary = p.recording->summary();
  if (p.stage == Impl::Stage::finished) return summary;
  if (p.stage == Impl::Stage::made) p.recorder.begin(summary.header);
  if (!has_ended()) (void)p.recording->account().interrupt("stopped at time " + std::to_string(p.state.time));
  if (summary.status != RunStatus::ok) (void)p.system.set_time(p.state.time);  // a failed step may have left another
  p.recording->hand_out(p.state);
  p.stage = Impl::Stage::finished;
  judge({p.scene, p.options, p.system, p.state, *p.recording, *p.analysis,
         p.asked.measured.time || p.asked.checks_estimate});
  if (p.asked.after_run) p.asked.after_run(p.system, p.state);
  p.recorder.end(summary);
  return summary;
}

}  // namespace bough::run
