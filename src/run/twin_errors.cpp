#include "twin_errors.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "bough/io/number_text.hpp"
#include "bough/run/measures.hpp"
#include "bough/scene/analysis_kinds.hpp"
#include "growing_distance.hpp"

namespace bough::run {

using records::ErrorOf;
using records::ErrorPart;
using records::ErrorState;
using records::MeasuredErrors;
using Kind = ComparedColumns::Kind;

namespace {

constexpr double rounding = 1e-13;  ///< of sums and of motions integrated, relative to the largest value of a unit

/// One kind of error: its members and their theory.
struct Twinned {
  std::vector<const TwinRun*> twins;  ///< null: the run itself; the finest first
  int run = 0;                        ///< place of the run
  double order = 0.0;                 ///< 0: members differ in load steps, on which results do not depend
  std::string missing;                ///< why there are no twins; then there is nothing else
};

/// Order of the error in time of the integrator.
double order_in_time(const RunWithTwins& run) {
  const scene::Analysis& analysis = run.scene.analysis;
  if (!scene::type_of(analysis.kind).integrates) return 0.0;
  if (analysis.integrator != scene::Integrator::bdf) return 2.0;
  const auto& options = run.summary.options;
  const bool is_second = std::find(options.begin(), options.end(),
                                   std::pair<std::string, std::string>("analysis/bdf_order", "2")) != options.end();
  return is_second ? 2.0 : 3.0;
}

/// Nodes of beams of order k converge with 2 k.
double order_of_mesh(const scene::Scene& scene) {
  int order = 3;
  for (const scene::Beam& b : scene.beams) order = std::min(order, b.order);
  return 2.0 * order;
}

/// The run and its twins of a kind, each half as fine as the one before.
Twinned twinned(const RunWithTwins& run, bool is_of_mesh) {
  Twinned t;
  std::vector<std::pair<double, const TwinRun*>> members = {{1.0, nullptr}};
  for (const TwinRun& twin : run.twins) {
    if (twin.is_of_mesh != is_of_mesh) continue;
    if (twin.summary.status != records::RunStatus::ok)
      t.missing = "a twin failed: " + twin.summary.cause;
    else
      members.emplace_back(is_of_mesh ? twin.factor : 1.0 / twin.factor, &twin);
  }
  std::sort(members.begin(), members.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  auto at = static_cast<std::size_t>(
      std::find_if(members.begin(), members.end(), [](const auto& m) { return m.second == nullptr; }) -
      members.begin());
  const auto is_half = [&](std::size_t k) { return members[k].first == 0.5 * members[k - 1].first; };
  std::size_t begin = at, end = at + 1;
  while (begin > 0 && is_half(begin)) --begin;
  while (end < members.size() && is_half(end)) ++end;
  for (std::size_t k = begin; k < end; ++k) t.twins.push_back(members[k].second);
  t.run = static_cast<int>(at - begin);
  t.order = is_of_mesh ? order_of_mesh(run.scene) : order_in_time(run);
  return t;
}

/// Largest magnitudes by unit.
class Scales {
 public:
  explicit Scales(const RunWithTwins& run) : header_(run.summary.header) {
    const auto see = [this](const std::vector<double>& values) {
      for (std::size_t c = 0; c < std::min(values.size(), header_.columns.size()); ++c) {
        double& largest = largest_[unit(c)];
        largest = std::max(largest, std::abs(values[c]));
      }
    };
    for (const auto& values : run.series.values) see(values);
    for (const auto& row : run.rows) see(row.values);
    compare_motions(run);
    compare_forces(run.summary.checks.energy_scale);
  }
  std::string unit(std::size_t c) const { return c < header_.about.size() ? header_.about[c].unit : std::string(); }
  double of(std::size_t c) const { return largest_.at(unit(c)); }

 private:
  /// What does not move but for round-off is compared with the structure, and a rate with what the structure's motion
  /// makes of it.
  void compare_motions(const RunWithTwins& run) {
    largest_["m"] = std::max(largest_["m"], run.size);
    largest_["rad"] = std::max(largest_["rad"], 1.0);
    const double time = run.series.times.empty() ? 0.0 : run.series.times.back() - run.series.times.front();
    if (!scene::type_of(run.scene.analysis.kind).integrates || !(time > 0.0)) return;
    double& turning = largest_["rad/s"];
    turning = std::max(turning, 1.0 / time);
    largest_["m/s"] = std::max(largest_["m/s"], run.size * turning);
  }

  /// A force that is zero but for round-off is compared with moments over the size of the structure, as far as sensors
  /// tell it, and with a part of the energy over it (as reactions are, judgement.cpp); a moment with the same.
  void compare_forces(double energy) {
    constexpr double part_of_energy = 1e-3;
    const double size = largest_["m"];
    double& moment = largest_["N m"];
    double& force = largest_["N"];
    moment = std::max({moment, part_of_energy * std::max(energy, largest_["J"]), force * size});
    if (size > 0.0) force = std::max(force, moment / size);
  }

  const records::HistoryHeader& header_;
  std::map<std::string, double> largest_;
};

/// Of load steps: equilibria do not depend on them, unless one leads to another equilibrium.
Extrapolation compare_equilibria(const MemberDifferences& d, std::span<const double> times, const ErrorTheory& theory) {
  ErrorTheory any = theory;
  any.order = 1.0;
  Extrapolation e = extrapolate(d, times, 0, any);
  e.error.clear();
  e.part.theoretical_order = e.part.at_end = 0.0;
  if (e.part.state == ErrorState::round_off || times.empty()) return e;
  const bool is_equal = e.part.largest <= theory.floor;
  e.part.state = is_equal ? ErrorState::round_off : ErrorState::not_resolved;
  if (is_equal)
    e.part.largest = e.part.root_mean_square = theory.floor;
  else
    e.part.cause = "load steps half as long lead to other equilibria from " + io::rounded_text(e.part.when, 4) + " on";
  return e;
}

/// Steps of the run a period of the vibration in which members differ, by how often their difference turns back; 0: it
/// turns seldom.
double steps_a_period(const MemberDifferences& d, std::span<const double> times, double step) {
  constexpr double seldom = 32.0;  // a twin of four times the step has eight steps a period left
  if (times.size() < 4) return 0.0;
  double turns = 0.0;
  const auto at = [&d](std::size_t k) { return d.fine[k * d.width]; };
  for (std::size_t k = 2; k < times.size(); ++k)
    turns += (at(k) - at(k - 1)) * (at(k - 1) - at(k - 2)) < 0.0 ? 1.0 : 0.0;
  const double steps = turns > 0.0 ? 2.0 * (times.back() - times.front()) / (turns * step) : 0.0;
  return steps < seldom ? steps : 0.0;
}

/// All that is told of one kind of error.
class Part {
 public:
  Part(const RunWithTwins& run, bool is_of_mesh, bool is_wanted)
      : run_(run), is_of_mesh_(is_of_mesh), is_wanted_(is_wanted) {
    if (is_wanted_) twinned_ = twinned(run, is_of_mesh);
    std::vector<const MemberSeries*> series;
    for (const TwinRun* twin : twinned_.twins) series.push_back(twin != nullptr ? &twin->series : &run.series);
    if (series.size() > 1) family_.emplace(std::move(series), twinned_.run);
  }

  bool is_wanted() const { return is_wanted_; }
  const Family* family() const { return family_ ? &*family_ : nullptr; }

  Extrapolation of(const ComparedColumns& columns, double scale) const {
    if (!family_) return missing();
    return eval(family_->differences(columns), family_->times(), scale);
  }
  /// Of a figure. value: of a summary, if it has one.
  template <class F>
  Extrapolation of_figure(double scale, const F& value) const {
    if (!family_) return missing();
    MemberDifferences d;
    std::optional<double> last;
    for (std::size_t k = 0; k < twinned_.twins.size(); ++k) {
      const TwinRun* const twin = twinned_.twins[k];
      const std::optional<double> next = value(twin != nullptr ? twin->summary : run_.summary);
      if (!next) return missing("a member has no value");
      if (k > 0) (k == 1 ? d.fine : d.coarse).push_back(*last - *next);
      last = next;
    }
    const double end = run_.series.times.empty() ? 0.0 : run_.series.times.back();
    return eval(d, std::vector<double>{end}, scale);
  }

 private:
  Extrapolation missing(const std::string& why = {}) const {
    Extrapolation e;
    e.part.cause = why.empty() ? twinned_.missing : why;
    return e;
  }
  Extrapolation eval(const MemberDifferences& d, std::span<const double> times, double scale) const {
    const ErrorTheory theory{twinned_.order, rounding * scale, run_.scene.analysis.tolerance * scale};
    if (twinned_.order == 0.0) return compare_equilibria(d, times, theory);
    Extrapolation e = extrapolate(d, times, twinned_.run, theory);
    if (e.part.state == ErrorState::not_resolved && is_of_mesh_ && e.part.cause.empty() && run_.scene.beams.size() == 1)
      e.part.cause = "beam '" + run_.scene.beams.front().name + "' has too few elements";
    if (e.part.state == ErrorState::not_resolved && !is_of_mesh_)
      if (const double steps = steps_a_period(d, times, run_.scene.analysis.step_size); steps > 0.0)
        e.part.cause = "members differ by a vibration of about " + io::rounded_text(steps, 2) +
                       " steps a period or less, which the longer steps do not resolve";
    return e;
  }

  const RunWithTwins& run_;
  bool is_of_mesh_, is_wanted_;
  Twinned twinned_;
  std::optional<Family> family_;
};

/// Adds what one kind of error adds to a row of errors; false if it is not known.
struct RowPart {
  const std::vector<double>* times;
  const Extrapolation* found;
  bool is_wanted;
  bool is_known() const { return !is_wanted || found->part.is_known(); }
  void eval(double time, std::size_t width, double* error) const {
    for (std::size_t i = 0; i < width; ++i) error[i] = 0.0;
    if (is_wanted && !found->error.empty()) interpolate(*times, found->error, width, time, error);
  }
};

void apply(const ComparedColumns& columns, const double* error, double* values) {
  if (columns.kind == Kind::number)
    *values += *error;
  else
    turn(columns, error, values);
}

/// Values of a row in the columns of errors.csv: extrapolated, error in time, error of the mesh of each.
void append_errors(const ComparedColumns& columns, const records::HistoryRow& row, const RowPart& time,
                   const RowPart& mesh, std::vector<double>& out) {
  const std::size_t width = columns.kind == Kind::number ? 1 : 3;
  const double* const from = row.values.data() + columns.first;
  double of_time[3], of_mesh[3], values[3][4];
  time.eval(row.time, width, of_time);
  mesh.eval(row.time, width, of_mesh);
  for (auto& v : values) std::copy(from, from + columns.count, v);
  apply(columns, of_time, values[1]);
  apply(columns, of_mesh, values[2]);
  for (std::size_t i = 0; i < width; ++i) of_time[i] += of_mesh[i];
  apply(columns, of_time, values[0]);
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < columns.count; ++i) {
    out.push_back(time.is_known() && mesh.is_known() ? values[0][i] : none);
    out.push_back(time.is_wanted && time.is_known() ? values[1][i] - from[i] : none);
    out.push_back(mesh.is_wanted && mesh.is_known() ? values[2][i] - from[i] : none);
  }
}

double range_of(const RunWithTwins& run, const ComparedColumns& columns) {
  double range = 0.0;
  for (std::size_t c = columns.first; c < columns.first + columns.count; ++c) {
    double low = 0.0, high = 0.0;
    bool is_first = true;
    for (const records::HistoryRow& row : run.rows) {
      low = is_first ? row.values[c] : std::min(low, row.values[c]);
      high = is_first ? row.values[c] : std::max(high, row.values[c]);
      is_first = false;
    }
    range = std::max(range, high - low);
  }
  return range;
}

void add_header(const records::HistoryHeader& header, records::HistoryHeader& errors) {
  errors.runs_over_load = header.runs_over_load;
  for (std::size_t c = 0; c < header.columns.size(); ++c)
    for (const char* what : {".extrapolated", ".error_in_time", ".error_of_mesh"}) {
      errors.columns.push_back(header.columns[c] + what);
      if (c < header.about.size()) errors.about.push_back(header.about[c]);
    }
}

double limit_of(double value, const ErrorOf& e, bool wants_time, bool wants_mesh) {
  if ((wants_time && !e.time.is_known()) || (wants_mesh && !e.mesh.is_known()))
    return std::numeric_limits<double>::quiet_NaN();
  return value + e.time.at_end + e.mesh.at_end;
}

class ErrorReport {
 public:
  explicit ErrorReport(const RunWithTwins& run)
      : run_(run),
        scales_(run),
        time_(run, false, errors_of(run.scene).time),
        mesh_(run, true, errors_of(run.scene).mesh) {}

  MeasuredErrors make() {
    errors_.remarks = run_.remarks;
    for (const TwinRun& t : run_.twins)
      errors_.members.push_back({t.is_of_mesh, t.factor, t.summary.status, t.summary.cause, t.seconds});
    add_columns();
    add_figures();
    return std::move(errors_);
  }

 private:
  void add_columns() {
    const records::HistoryHeader& header = run_.summary.header;
    add_header(header, errors_.header);
    for (const records::HistoryRow& row : run_.rows)
      errors_.rows.push_back({row.time, row.step_size, row.iterations, {}});
    GrowingDistance growing;
    for (const ComparedColumns& columns : compared_columns(header)) {
      const double scale = columns.kind == Kind::number ? scales_.of(columns.first) : 1.0;
      const Extrapolation time = time_.of(columns, scale), mesh = mesh_.of(columns, scale);
      const double range = columns.kind == Kind::number ? sensor_range(columns.first) : range_of(run_, columns);
      if (time_.family() != nullptr && range > rounding * scale)
        growing.add(time_.family()->differences(columns), range);
      for (std::size_t i = 0; i < columns.count; ++i) add_column(columns.first + i, range, time.part, mesh.part);
      add_rows(columns, time, mesh);
    }
    if (time_.family() == nullptr) return;
    if (const auto told = growing.look(time_.family()->times())) tell(*told);
  }

  /// Largest minus least value over the columns of a sensor with the same unit; of energies no less than the largest
  /// energy, since the range of one that is conserved is its error.
  double sensor_range(std::size_t column) {
    const auto& columns = run_.summary.header.columns;
    const std::string sensor = columns[column].substr(0, columns[column].rfind('.'));
    const auto [at, is_new] = ranges_.try_emplace({sensor, scales_.unit(column)}, 0.0);
    if (is_new)
      for (std::size_t c = 0; c < columns.size(); ++c)
        if (columns[c].substr(0, columns[c].rfind('.')) == sensor && scales_.unit(c) == scales_.unit(column))
          at->second = std::max(at->second, range_of(run_, {Kind::number, c, 1}));
    return scales_.unit(column) == "J" ? std::max(at->second, run_.summary.checks.energy_scale) : at->second;
  }

  void add_column(std::size_t c, double range, const ErrorPart& time, const ErrorPart& mesh) {
    ErrorOf e;
    e.name = run_.summary.header.columns[c];
    e.unit = scales_.unit(c);
    e.value = run_.rows.empty() ? 0.0 : run_.rows.back().values[c];
    e.range = range;
    e.time = time;
    e.mesh = mesh;
    errors_.columns.push_back(std::move(e));
  }

  void add_rows(const ComparedColumns& columns, const Extrapolation& time, const Extrapolation& mesh) {
    static const std::vector<double> no_times;
    const RowPart in_time{time_.family() != nullptr ? &time_.family()->times() : &no_times, &time, time_.is_wanted()};
    const RowPart of_mesh{mesh_.family() != nullptr ? &mesh_.family()->times() : &no_times, &mesh, mesh_.is_wanted()};
    for (std::size_t r = 0; r < run_.rows.size(); ++r)
      append_errors(columns, run_.rows[r], in_time, of_mesh, errors_.rows[r].values);
    if (errors_.rows.empty()) return;
    for (std::size_t i = 0; i < columns.count; ++i) {
      ErrorOf& e = errors_.columns[columns.first + i];
      const double* const last = errors_.rows.back().values.data() + 3 * (columns.first + i);
      e.extrapolated = last[0];
      if (e.time.is_known()) e.time.at_end = last[1];
      if (e.mesh.is_known()) e.mesh.at_end = last[2];
      if (columns.kind == Kind::number) continue;
      take_from_rows(columns, 3 * (columns.first + i) + 1, e.time);
      take_from_rows(columns, 3 * (columns.first + i) + 2, e.mesh);
    }
  }

  /// Of a rotation errors are angles, and those of its columns are in the rows.
  void take_from_rows(const ComparedColumns& columns, std::size_t place, ErrorPart& part) const {
    if (part.state == ErrorState::not_resolved && columns.kind == Kind::quaternion) {
      part.largest *= 0.5;  // of half the angle
      part.root_mean_square *= 0.5;
      part.spread *= 0.5;
    }
    if (part.state != ErrorState::resolved && part.state != ErrorState::unexamined) return;
    part.largest = part.root_mean_square = 0.0;
    for (const records::HistoryRow& row : errors_.rows) {
      const double error = std::abs(row.values[place]);
      part.root_mean_square += error * error / static_cast<double>(errors_.rows.size());
      if (error <= part.largest) continue;
      part.largest = error;
      part.when = row.time;
    }
    part.root_mean_square = std::sqrt(part.root_mean_square);
  }

  void add_figures() {
    const records::Summary& s = run_.summary;
    for (std::size_t k = 0; k < s.expected.size(); ++k) {
      const auto value = [k](const records::Summary& of) -> std::optional<double> {
        const records::ExpectedResult& e = of.expected[k];
        return e.reached && e.has_value && std::isfinite(e.value) ? std::optional(e.value) : std::nullopt;
      };
      errors_.expected.push_back(figure(s.expected[k].name, "", value));
    }
    const std::vector<std::string> units = units_of_measures(run_.scene, s.header);
    for (std::size_t k = 0; k < s.measures.size(); ++k)
      errors_.measures.push_back(figure(s.measures[k].name, k < units.size() ? units[k] : "",
                                        [k](const records::Summary& of) { return of.measures[k].value; }));
  }

  template <class F>
  ErrorOf figure(const std::string& name, const std::string& unit, const F& value) const {
    ErrorOf e;
    e.name = name;
    e.unit = unit;
    const std::optional<double> own = value(run_.summary);
    if (!own) return e;
    e.value = *own;
    e.time = time_.of_figure(std::abs(*own), value).part;
    e.mesh = mesh_.of_figure(std::abs(*own), value).part;
    e.extrapolated = limit_of(*own, e, time_.is_wanted(), mesh_.is_wanted());
    return e;
  }

  /// Of a sensitive motion: what is not resolved is so for this reason.
  void tell(const Sensitivity& s) {
    std::string text =
        "the motion is sensitive: members drift apart by e every " + io::rounded_text(s.grows_in, 2) + " s";
    if (s.lost_from)
      text += "; after " + io::rounded_text(*s.lost_from, 3) + " s no digit of it is known, only what holds on average";
    for (ErrorOf& e : errors_.columns)
      if (e.time.state == ErrorState::not_resolved) e.time.cause = text;
    errors_.remarks.push_back(text);
  }

  const RunWithTwins& run_;
  Scales scales_;
  Part time_, mesh_;
  std::map<std::pair<std::string, std::string>, double> ranges_;
  MeasuredErrors errors_;
};

}  // namespace

MeasuredErrors measure_errors(RunWithTwins run) { return ErrorReport(run).make(); }

}  // namespace bough::run
