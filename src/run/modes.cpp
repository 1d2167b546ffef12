/// Modes of vibration about a state.
#include "bough/step/modes.hpp"

#include <algorithm>
#include <memory>
#include <numbers>

#include "at_state.hpp"
#include "mode_parts.hpp"
#include "mode_pictures.hpp"
#include "not_judged.hpp"

namespace bough::run {

namespace {

using step::Linearisation;

constexpr double whole_turn = 2.0 * std::numbers::pi;

/// Looks for modes about the state of time 0, or about the equilibrium.
class Modes final : public AtState {
 public:
  explicit Modes(const Parts& parts) : AtState(parts) {}
  std::unique_ptr<Analysis> clone() const override { return std::make_unique<Modes>(*this); }
  void add_doubts() override {
    AtState::add_doubts();
    if (!missing_.empty()) summary().doubts.push_back({"modes", missing_});
  }
  std::string not_judged() const override { return one_line({plan_.beams.empty() ? "" : the_mesh, not_proved_}); }

 protected:
  bool look(Linearisation& linear) override {
    step::ModesFound found = about_.find_modes(linear, scene_.analysis.modes);
    if (!found.cause.empty()) return fail("no modes are found: " + found.cause);
    tell_notes();
    tell(linear, found);
    return true;
  }

 private:
  void tell(const Linearisation& linear, step::ModesFound& found);
  records::Table table_of(const Linearisation& linear, std::vector<step::Mode>& modes);
  void tell_completeness(const step::ModesFound& found);

  std::string missing_, not_proved_;
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
  table.about = "Modes about " + about_.text() +
                (found.is_symmetric              ? "; undamped. "
                 : scene_.analysis.modes.damping ? "; damped. "
                                                 : "; dampers left out. ") +
                "Shapes have modal mass 1. " + (rigid > 0 ? std::to_string(rigid) + " rigid. " : "") +
                (unstable > 0 ? std::to_string(unstable) + " unstable. " : "") +
                (found.missing && *found.missing == 0 ? "None is missing, by the signs of pivots." : "");
  while (table.about.back() == ' ') table.about.pop_back();
  if (unstable > 0)
    note("the state is unstable: " + std::to_string(unstable) + (unstable == 1 ? " mode grows" : " modes grow"));
  summary().tables.push_back(std::move(table));
  draw_modes(recording_, system_, state_, found.modes);
}

}  // namespace

std::unique_ptr<Analysis> make_modes(const Parts& parts) { return std::make_unique<Modes>(parts); }

}  // namespace bough::run
