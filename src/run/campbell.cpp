/// Modes over a parameter of the scene, followed from value to value.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "about_state.hpp"
#include "analysis.hpp"
#include "bough/io/number_text.hpp"
#include "mode_branches.hpp"
#include "mode_parts.hpp"
#include "not_judged.hpp"

namespace bough::run {

namespace {

constexpr double turn = 2.0 * std::numbers::pi;

/// One value of the parameter is a step: a plan, a state and modes of its own, which continue branches found so far.
class Campbell final : public Analysis {
 public:
  explicit Campbell(const Parts& parts) : Analysis(parts) {}
  std::unique_ptr<Analysis> clone() const override { return std::make_unique<Campbell>(*this); }
  bool begin() override {
    AboutState about(scene_, system_, state_, options_);
    if (const std::string cause = about.find(); !cause.empty()) return fail(cause);
    record(0, true);
    return true;
  }
  bool take_step() override;
  bool is_done() const override { return next_ == asked().values.size(); }
  bool ends_in_correction() const override { return false; }
  void checkpoint(records::Archive& archive) override {
    Analysis::checkpoint(archive);
    archive(next_, branches_, from_where_, doubts_);
  }
  void sum_up() override;
  void add_doubts() override {
    for (const std::string& text : doubts_) summary().doubts.push_back({"state", text});
    if (const std::string text = branches_.doubt(asked().values); !text.empty())
      summary().doubts.push_back({"branches", text});
  }
  std::string not_judged() const override {
    return one_line({plan_.beams.empty() ? "" : the_mesh, "that no mode is missing among those listed is not proved"});
  }

 private:
  const scene::CampbellAsked& asked() const { return scene_.analysis.campbell; }
  std::string at_value() const {
    return "at " + asked().parameter + " = " + io::rounded_text(asked().values[next_], 9) + ": ";
  }
  records::Table table_of_branches() const;
  records::Table table_of_events() const;

  std::size_t next_ = 0;
  ModeBranches branches_;
  std::string from_where_;
  std::vector<std::string> doubts_;
};

bool Campbell::take_step() {
  constexpr int spare = 4;  // modes beyond those asked for, so that branches that cross the last one are not lost
  if (!may_try(static_cast<double>(next_))) return false;
  const scene::Scene& scene = *asked().scenes[next_];
  const plan::Plan plan = plan::make_plan(scene);
  step::System system(plan, scene.solver, system_.walker());
  step::State state = step::make_initial_state(plan);
  AboutState about(scene, system, state, options_);
  if (const std::string cause = about.find(); !cause.empty()) return fail(at_value() + cause);
  account().newton_iterations() += about.iterations();
  step::Linearisation linear(system);
  if (const std::string cause = about.linearise(linear); !cause.empty()) return fail(at_value() + cause);
  scene::ModesAsked wanted = scene_.analysis.modes;
  wanted.count += spare;
  step::ModesFound found = about.find_modes(linear, wanted);
  if (!found.cause.empty()) return fail(at_value() + "no modes are found: " + found.cause);
  if (doubts_.empty())
    for (const std::string& text : about.doubts()) doubts_.push_back(at_value() + text);
  from_where_ = about.text();
  const ModeParts parts(linear, state);
  for (step::Mode& mode : found.modes) parts.normalise(mode);
  if (const std::string cause =
          branches_.add(linear, std::move(found.modes), [&](const step::Mode& mode) { return parts.describe(mode); });
      !cause.empty())
    return fail(at_value() + cause);
  step::StepReport reached;
  reached.converged = true;
  ++next_;
  count(reached);
  report_progress(reached, static_cast<double>(asked().values.size()));
  return true;
}

void Campbell::sum_up() {
  branches_.keep(static_cast<std::size_t>(scene_.analysis.modes.count));
  summary().tables.push_back(table_of_branches());
  if (records::Table events = table_of_events(); !events.rows.empty()) summary().tables.push_back(std::move(events));
}

records::Table Campbell::table_of_branches() const {
  records::Table table{"campbell",
                       "Modes about " + from_where_ + ", over " + asked().parameter +
                           ". A branch is followed by the likeness of shapes (MAC) from one value to the next.",
                       {{"branch", "", true},
                        {"value", "", true},
                        {"frequency", "Hz", true},
                        {"angular_frequency", "rad/s"},
                        {"damping_ratio", "", true},
                        {"real_part", "1/s"},
                        {"imaginary_part", "rad/s"},
                        {"mac"},
                        {"residual"},
                        {"what", "", true}},
                       {}};
  for (std::size_t b = 0; b < branches_.all().size(); ++b)
    for (const ModeBranches::Point& p : branches_.all()[b]) {
      const double size = p.eigenvalue.imag() > 0.0 ? std::abs(p.eigenvalue) : 0.0;
      table.rows.push_back({std::to_string(b + 1), asked().values[p.at], size / turn, size,
                            size > 0.0 ? -p.eigenvalue.real() / size + 0.0 : 0.0, p.eigenvalue.real(),
                            p.eigenvalue.imag(), p.likeness, p.residual, p.what});
    }
  for (const double order : asked().speed > 0.0 ? asked().orders : std::vector<double>())
    for (const double value : asked().values) {
      const double w = order * asked().speed * value;
      table.rows.push_back({io::rounded_text(order, 6) + "x", value, w / turn, w, 0.0, 0.0, w, 1.0, 0.0,
                            "excitation of order " + io::rounded_text(order, 6)});
    }
  return table;
}

/// Where an imaginary part meets a multiple of the speed, and where a real part becomes positive. Two vibrations that meet
/// and then flutter have eigenvalues that change as the root of the way from there; their mean and the square of their
/// difference, which changes its sign, do not.
records::Table Campbell::table_of_events() const {
  records::Table table{
      "critical",
      "Values at which a vibration has the frequency of an excitation, or two vibrations meet and begin "
      "to flutter, by the cubic through the four nearest points; and values between which a vibration "
      "begins to grow for other reasons, about their middle.",
      {{"event", "", true}, {"branch", "", true}, {"value", "", true}, {"frequency", "Hz", true}, {"what", "", true}},
      {}};
  const std::vector<double>& values = asked().values;
  const std::vector<ModeBranches::Branch>& all = branches_.all();
  const auto add = [&](const std::string& event, const std::string& branch, double value, double w,
                       const std::string& what) {
    table.rows.push_back({event, branch, value, w / turn, what});
  };
  const auto grows = [](const std::complex<double>& lambda) { return lambda.real() > 1e-6 * std::abs(lambda); };
  for (std::size_t b = 0; b < all.size(); ++b) {
    const ModeBranches::Branch& branch = all[b];
    const std::string name = std::to_string(b + 1);
    for (const double order : asked().speed > 0.0 ? asked().orders : std::vector<double>())
      for (const double value : zeros_along(branch, values, [&](std::complex<double> lambda, double at) {
             return lambda.imag() - order * asked().speed * at;
           }))
        add("critical speed of order " + io::rounded_text(order, 6), name, value,
            value_along(branch, values, value).imag(), branch.back().what);
    for (std::size_t k = 1; k < branch.size(); ++k) {
      if (grows(branch[k - 1].eigenvalue) || !grows(branch[k].eigenvalue)) continue;
      const double low = values[branch[k - 1].at], high = values[branch[k].at];
      const std::size_t mirror = branches_.mirror_of(b, branch[k].at);
      std::vector<double> met;
      if (mirror < all.size())
        met = zeros_along(combined(branch, all[mirror], [](auto x, auto y) { return (x - y) * (x - y); }), values,
                          [](std::complex<double> square, double) { return square.real(); });
      std::erase_if(met, [&](double value) { return value < low || value > high; });
      if (met.empty()) {
        add("onset of growth", name, 0.5 * (low + high), branch[k].eigenvalue.imag(), branch[k].what);
        continue;
      }
      const auto mean = combined(branch, all[mirror], [](auto x, auto y) { return 0.5 * (x + y); });
      add("onset of flutter", name + " and " + std::to_string(mirror + 1), met.front(),
          value_along(mean, values, met.front()).imag(), branch[k].what);
    }
  }
  return table;
}

}  // namespace

std::unique_ptr<Analysis> make_campbell(const Parts& parts) { return std::make_unique<Campbell>(parts); }

}  // namespace bough::run
