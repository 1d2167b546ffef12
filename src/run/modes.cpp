/// Modes of vibration about a state.
#include "bough/step/modes.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "analysis.hpp"
#include "bough/io/number_text.hpp"
#include "bough/step/find_equilibrium.hpp"
#include "mode_parts.hpp"
#include "mode_steadiness.hpp"
#include "not_judged.hpp"
#include "turning_start.hpp"

namespace bough::run {

namespace {

using step::Linearisation;
using Part = Linearisation::Part;

constexpr double symmetric_to_round_off = 1e-9;  ///< relative difference from a symmetric matrix that is round-off
constexpr double still = 1e-6;  ///< inertia forces over the largest force above which a state is no equilibrium
constexpr double stiff_round_off = 1e-12;  ///< of accelerations, over the largest squared frequency and the size
constexpr double whole_turn = 2.0 * std::numbers::pi;

/// Takes the state of time 0, or finds the equilibrium, and looks for modes about it.
class Modes final : public Analysis {
 public:
  explicit Modes(const Parts& parts) : Analysis(parts) {}
  std::unique_ptr<Analysis> clone() const override { return std::make_unique<Modes>(*this); }

  bool begin() override {
    if (const auto trouble = system_.set_time(0.0, laws::Side::right)) return fail(trouble->text);
    if (scene_.analysis.start == scene::StartKind::equilibrium && !find_equilibrium()) return false;
    // At rest the equilibrium is consistent: drives are held, whatever their laws do next.
    const bool rests = scene_.analysis.start == scene::StartKind::equilibrium && is_at_rest();
    if (!rests && !make_consistent()) return false;
    if (moved_ > 1e-9)
      note("the start was moved by up to " + io::rounded_text(moved_, 3) + " (relative) to close the joints");
    record(0, true);
    return true;
  }

  bool take_step() override {
    if (!may_try(0.0)) return false;
    Linearisation linear(system_);
    if (const auto trouble = linear.take(state_)) return fail(trouble->text);
    look_at_balance(linear);
    choose_axes(linear);
    step::ModesFound found = find(linear);
    if (!found.cause.empty()) return fail("no modes are found: " + found.cause);
    tell(linear, found);
    step::StepReport report;
    report.converged = true;
    count(report);
    is_done_ = true;
    return true;
  }
  bool is_done() const override { return is_done_; }
  bool ends_in_correction() const override { return false; }
  void checkpoint(records::Archive& archive) override {
    Analysis::checkpoint(archive);
    archive(is_done_);
  }
  void add_doubts() override {
    if (!imbalance_.empty()) summary().doubts.push_back({"state", imbalance_});
    if (!unsteady_.empty()) summary().doubts.push_back({"state", unsteady_});
    if (!missing_.empty()) summary().doubts.push_back({"modes", missing_});
  }
  std::string not_judged() const override { return one_line({plan_.beams.empty() ? "" : the_mesh, not_proved_}); }

 private:
  bool find_equilibrium() {
    const std::optional<scene::Spin> spin = spin_at_start(scene_, plan_);
    const step::EquilibriumReport rest =
        spin ? find_turning_equilibrium(scene_, plan_, *spin, options_, state_)
             : step::find_equilibrium(system_, state_, options_, scene_.analysis.step_size);
    account().newton_iterations() += rest.iterations;
    if (!rest.found)
      return fail("there is no equilibrium for modes to be about: " + rest.cause +
                  "; \"about\": \"start\" takes the state as the scene gives it");
    note("modes are about the equilibrium under the loads of time 0, which is up to " +
         io::rounded_text(rest.moved, 3) + " of the size of the structure, or rad, from the places of the scene");
    return true;
  }
  bool is_at_rest() const {
    const std::vector<elements::NodeMotion>& nodes = step::nodes_in_space(plan_, state_);
    return std::all_of(nodes.begin(), nodes.end(), [](const auto& n) { return lanes::dot(n.v, n.v) == 0.0; });
  }
  bool make_consistent() {
    const step::StartReport report =
        step::make_consistent_on(system_, state_, true, scene_.analysis.step_size, laws::Side::right);
    moved_ = std::max(moved_, report.position_correction);
    return report.ok || fail(report.cause);
  }

  /// In an equilibrium or a steady motion the components of velocities in own axes do not change.
  void look_at_balance(const Linearisation& linear) {
    std::vector<double> a(linear.size(), 0.0), force(linear.size());
    const std::vector<elements::NodeMotion>& nodes = step::nodes_in_space(plan_, state_);
    for (std::size_t n = 0; n < nodes.size(); ++n)
      system_.places().set_node_part(a.data(), static_cast<int>(n), nodes[n].a);
    linear.multiply(Part::mass, a, force);
    if (system_.evaluate(state_, {}, false)) return;
    const step::ResidualSize size = system_.residual_size();
    const double scale = std::max(size.force_scale, size.moment_scale / plan_.length_scale);
    double most = 0.0;
    for (std::size_t i = 0; i < force.size(); ++i)
      if (const double w = linear.weights()[i]; w > 0.0)
        most = std::max(most, std::abs(force[i]) * (w == 1.0 ? 1.0 / plan_.length_scale : 1.0));
    const int node = linear.largest_node(a);
    if (!(most > still * scale) || node < 0) return;
    const motion::Vec6<double>& fastest = nodes[static_cast<std::size_t>(node)].a;
    const double acceleration = length_of(lanes::linear_part(fastest));
    // Of what round-off of positions makes in the stiffest parts nothing is told.
    if (acceleration + plan_.length_scale * length_of(lanes::angular_part(fastest)) <
        stiff_round_off * linear.fastest() * plan_.length_scale)
      return;
    imbalance_ = "the state is no equilibrium and no steady motion: '" +
                 plan_.nodes[static_cast<std::size_t>(node)].name + "' accelerates, by " +
                 io::rounded_text(acceleration, 3) + " m/s^2, and " + io::rounded_text(100.0 * most / scale, 2) +
                 " % of the largest force is inertia; the modes are those of the equations as they stand at this "
                 "instant, and \"about\": \"equilibrium\" has them about the state of rest";
  }

  void choose_axes(Linearisation& linear) {
    if (is_at_rest()) return;
    const Steadiness steady = look_at_steadiness(system_, linear, state_);
    if (steady.from_ground)
      linear.describe_from_ground(state_);
    else
      linear.describe_from_parts(state_);
    is_from_ground_ = steady.from_ground;
    moves_ = true;
    unsteady_ = steady.doubt;
  }

  /// Symmetric equations have real modes; all others complex ones.
  step::ModesFound find(Linearisation& linear) {
    const scene::ModesAsked& asked = scene_.analysis.modes;
    bool has_damping = linear.largest(Part::damping) > 0.0;
    if (has_damping && !asked.damping) {
      const double before = linear.largest(Part::damping);
      linear.leave_out_dampers();
      has_damping = linear.largest(Part::damping) > 1e-12 * before;
      if (linear.largest(Part::damping) < (1.0 - 1e-9) * before)
        note("dampers are left out; \"damping\": true in /analysis has them count");
    }
    const bool is_conservative =
        plan_.not_conservative.empty() || linear.asymmetry(Part::stiffness) < symmetric_to_round_off;
    const step::ModesWanted wanted{asked.count, whole_turn * asked.shift};
    is_symmetric_ = is_conservative && !has_damping && plan_.num_driving_signals == 0;
    if (is_conservative && plan_.num_driving_signals == 0) linear.take_symmetric_part(Part::stiffness);
    return is_symmetric_ ? step::find_undamped_modes(linear, wanted) : step::find_complex_modes(linear, wanted);
  }

  void tell(const Linearisation& linear, step::ModesFound& found);
  records::Table table_of(const Linearisation& linear, std::vector<step::Mode>& modes);
  void tell_completeness(const step::ModesFound& found);
  void draw(const std::vector<step::Mode>& modes);

  bool is_done_ = false, is_symmetric_ = true, moves_ = false, is_from_ground_ = false;
  double moved_ = 0.0;
  std::string imbalance_, unsteady_, missing_, not_proved_;
};

const char* kind_of_mode(const step::Mode& mode) {
  if (mode.is_rigid) return "rigid";
  if (mode.eigenvalue.imag() > 0.0) return mode.grows() ? "growing vibration" : "vibration";
  return mode.grows() ? "growth" : "decay";
}

records::Table Modes::table_of(const Linearisation& linear, std::vector<step::Mode>& modes) {
  const ModeParts parts(linear, state_);
  std::vector<step::Mode> rigid;
  for (const step::Mode& mode : modes)
    if (mode.is_rigid) rigid.push_back(mode);
  const std::vector<std::string> rigid_names = parts.name_rigid(rigid);
  std::move(rigid.begin(), rigid.end(), modes.begin());
  records::Table table{"modes",
                       "",
                       {{"mode", "", true},
                        {"kind", "", true},
                        {"frequency", "Hz", true},
                        {"angular_frequency", "rad/s"},
                        {"damping_ratio", "", true},
                        {"real_part", "1/s"},
                        {"imaginary_part", "rad/s"},
                        {"residual"}},
                       {}};
  static const char* const directions[] = {"x", "y", "z", "about_x", "about_y", "about_z"};
  for (std::size_t k = 0; k < 6; ++k)
    table.columns.push_back({std::string("participation_") + directions[k], k < 3 ? "kg^0.5" : "kg^0.5 m"});
  for (std::size_t k = 0; k < 6; ++k)
    table.columns.push_back({std::string("effective_mass_") + directions[k], k < 3 ? "kg" : "kg m^2"});
  table.columns.push_back({"what", "", true});
  table.columns.push_back({"strain_energy_in", "", true});
  table.columns.push_back({"kinetic_energy_in"});
  for (std::size_t k = 0; k < modes.size(); ++k) {
    step::Mode& mode = modes[k];
    parts.normalise(mode);
    const double size = mode.vibrates() ? mode.frequency() : 0.0;
    std::vector<records::Table::Cell> row{static_cast<double>(k + 1),
                                          std::string(kind_of_mode(mode)),
                                          size / whole_turn,
                                          size,
                                          size > 0.0 ? -mode.eigenvalue.real() / size + 0.0 : 0.0,
                                          mode.eigenvalue.real(),
                                          mode.eigenvalue.imag(),
                                          mode.residual};
    const std::array<double, 6> factors = parts.participation(mode);
    row.insert(row.end(), factors.begin(), factors.end());
    for (const double factor : factors) row.emplace_back(factor * factor);
    row.emplace_back(mode.is_rigid ? rigid_names[k] : parts.describe(mode));
    row.emplace_back(mode.is_rigid ? std::string() : text_of(parts.strain_shares(mode)));
    row.emplace_back(text_of(parts.kinetic_shares(mode)));
    table.rows.push_back(std::move(row));
  }
  return table;
}

void Modes::tell_completeness(const step::ModesFound& found) {
  if (found.inexact > 0)
    missing_ = std::to_string(found.inexact) +
               " more were found that do not meet the equations to 1e-6, and are not listed: ask for fewer modes, or "
               "for those near a shift";
  if (!found.missing) {
    not_proved_ = "that no mode is missing among those listed is not proved";
  } else if (*found.missing > 0) {
    missing_ = std::to_string(*found.missing) +
               " more modes lie among those listed, by the signs of the pivots of a factorization, and were not found";
  }
}

void Modes::tell(const Linearisation& linear, step::ModesFound& found) {
  records::Table table = table_of(linear, found.modes);
  tell_completeness(found);
  const auto count = [&](auto&& is) { return std::count_if(found.modes.begin(), found.modes.end(), is); };
  const auto rigid = count([](const step::Mode&m) { return m.is_rigid; }),
             unstable = count([](const step::Mode&m) { return m.grows(); });
  table.about = std::string("Modes about ") +
                (scene_.analysis.start == scene::StartKind::equilibrium ? "the equilibrium under the loads of time 0"
                                                                        : "the state at time 0") +
                (plan_.observer >= 0 ? ", seen from the frame '" + scene_.analysis.frame + "'" : "") +
                (!moves_           ? ""
                 : is_from_ground_ ? ", which turns: frequencies are those seen from the ground"
                                   : ", which turns: frequencies are those seen from the parts that turn") +
                (is_symmetric_                   ? "; undamped. "
                 : scene_.analysis.modes.damping ? "; damped. "
                                                 : "; dampers left out. ") +
                "Shapes have modal mass 1. " + (rigid > 0 ? std::to_string(rigid) + " rigid. " : "") +
                (unstable > 0 ? std::to_string(unstable) + " unstable. " : "") +
                (found.missing && *found.missing == 0 ? "None is missing, by the signs of pivots." : "");
  while (table.about.back() == ' ') table.about.pop_back();
  if (unstable > 0)
    note("the state is unstable: " + std::to_string(unstable) + (unstable == 1 ? " mode grows" : " modes grow"));
  summary().tables.push_back(std::move(table));
  draw(found.modes);
}

/// Pictures of one period of each mode, mode k from time k - 1 to time k. What moves most moves by 6 % of the size of
/// the structure, or turns by 0.4 rad.
void Modes::draw(const std::vector<step::Mode>& modes) {
  constexpr double far = 0.06, most_turn = 0.4;
  constexpr std::size_t most_pictures = 300;
  const std::size_t pictures = std::clamp<std::size_t>(most_pictures / std::max<std::size_t>(modes.size(), 1), 8, 24);
  for (std::size_t k = 0; k < modes.size() && k * pictures < most_pictures; ++k) {
    double moves = 0.0, turns = 0.0;
    std::vector<double> re(modes[k].shape.size()), rate(re.size());
    for (const double phase : {0.0, 0.25}) {
      for (std::size_t i = 0; i < re.size(); ++i)
        re[i] = (modes[k].shape[i] * std::polar(1.0, whole_turn * phase)).real();
      for (std::size_t n = 0; n < plan_.nodes.size(); ++n) {
        const motion::Vec6<double> eta = system_.places().node_part(re.data(), static_cast<int>(n));
        moves = std::max(moves, length_of(lanes::linear_part(eta)) / plan_.length_scale);
        turns = std::max(turns, length_of(lanes::angular_part(eta)));
      }
    }
    const double largest = std::max(moves / far, turns / most_turn);
    if (!(largest > 0.0)) continue;
    for (std::size_t p = 0; p <= pictures; ++p) {
      if (p == pictures && k + 1 < modes.size()) break;  // the next mode begins there
      if (p == 0 && k == 0) continue;                    // the state itself was recorded
      const double phase = static_cast<double>(p) / static_cast<double>(pictures);
      // A sine of real shapes: every mode begins and ends in the state that it is about.
      const std::complex<double> swing = std::polar(1.0 / largest, whole_turn * (phase - 0.25)),
                                 speed = swing * whole_turn * std::complex<double>(0.0, 1.0);
      for (std::size_t i = 0; i < re.size(); ++i) {
        re[i] = (modes[k].shape[i] * swing).real();
        rate[i] = (modes[k].shape[i] * speed).real();
      }
      step::State shown = state_;
      shown.time = static_cast<double>(k) + phase;
      for (std::size_t n = 0; n < plan_.nodes.size(); ++n) {
        step::move_node(plan_, shown, n, system_.places().node_part(re.data(), static_cast<int>(n)));
        step::set_velocity(plan_, shown, n, system_.places().node_part(rate.data(), static_cast<int>(n)));
      }
      recording_.draw_shape(shown);
    }
  }
}

}  // namespace

std::unique_ptr<Analysis> make_modes(const Parts& parts) { return std::make_unique<Modes>(parts); }

}  // namespace bough::run
