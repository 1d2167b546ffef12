#include <algorithm>
#include <cmath>

#include "bough/io/number_text.hpp"
#include "bough/scene/analysis_kinds.hpp"
#include "study_converter.hpp"
#include "study_rules.hpp"

namespace bough::io {
namespace {

constexpr double dividing_slack = 1e-9;  // of a step

bool is_multiple(double whole, double part) {
  const double n = whole / part;
  return n > 0.5 && std::abs(n - std::round(n)) <= dividing_slack * n;
}

}  // namespace

/// The places in the study to which faults caused by these overrides are attributed.
void StudyConverter::add_origins(const std::vector<std::string>& overrides, const std::string& at,
                                 std::vector<SettingOrigin>& origins) {
  for (const std::string& o : overrides) origins.push_back({o.substr(0, o.find('=')), at});
}

StudyReference StudyConverter::read_reference(const Value& v, const std::string& at) {
  StudyReference r;
  r.at = at;
  r.overrides = read_settings(*v.find("set"), at + "/set");
  r.check_overrides = read_settings(*v.find("check"), at + "/check");
  r.order = v.find("order")->number;
  r.ratio = v.find("ratio")->number;
  r.about = v.find("about")->text;
  return r;
}

void StudyConverter::read_grid(const Value& v, const std::string& at) {
  StudyGrid grid;
  grid.name = v.find("name")->text;
  for (const StudyGrid& other : spec.grids)
    if (other.name == grid.name) fault(at + "/name", "this name is taken already", "names are used once");
  grid.overrides = read_settings(*v.find("set"), at + "/set");
  const Value& axes = *v.find("axes");
  for (std::size_t i = 0; i < axes.items.size(); ++i) {
    grid.axes.push_back(read_axis(axes.items[i], at + "/axes/" + std::to_string(i)));
    for (std::size_t k = 0; k < i; ++k)
      if (grid.axes[k].name == grid.axes[i].name)
        fault(at + "/axes/" + std::to_string(i) + "/name", "this name is taken already", "names are used once");
  }
  std::vector<std::string> names;
  for (const StudyAxis& axis : grid.axes) names.push_back(axis.name);
  const auto is_of_numbers = [](const StudyAxis& axis) {
    return std::all_of(axis.choices.begin(), axis.choices.end(),
                       [](const StudyChoice& c) { return std::isfinite(c.number) && c.number > 0.0; });
  };
  auto abscissa = std::find_if(grid.axes.begin(), grid.axes.end(), is_of_numbers);
  if (const Value* name = v.find("abscissa")) {
    abscissa =
        std::find_if(grid.axes.begin(), grid.axes.end(), [&](const StudyAxis& a) { return a.name == name->text; });
    if (abscissa == grid.axes.end())
      fault(at + "/abscissa", "no axis has this name", did_you_mean(name->text, names));
    else if (!is_of_numbers(*abscissa))
      fault(at + "/abscissa", "the values of the abscissa are numbers above 0");
  } else if (abscissa == grid.axes.end() && faults.empty()) {
    fault(at + "/axes", "one axis needs numbers above 0 for values", "choices may have a number, too: \"value\"");
  }
  if (abscissa != grid.axes.end()) grid.abscissa = static_cast<std::size_t>(abscissa - grid.axes.begin());
  if (const Value* reference = v.find("reference")) {
    grid.has_reference = true;
    grid.reference = read_reference(*reference, at + "/reference");
  }
  read_orders(*v.find("orders"), at + "/orders", grid);
  spec.grids.push_back(std::move(grid));
}

std::optional<StudyChoice> StudyConverter::read_value(const std::string& name, const std::string& pointer,
                                                      const Value& v, const std::string& at,
                                                      const std::string& pointer_at) {
  StudyChoice choice;
  choice.at = at;
  choice.label = v.is(JsonKind::string) ? v.text : slice(v);
  if (v.is(JsonKind::number)) choice.number = v.number;
  if (name == "threads" && pointer.empty()) {
    if (!v.is(JsonKind::number) || v.number != std::floor(v.number) || v.number < 1.0 || v.number > 1024.0) {
      fault(at, "has to be a whole number of at least 1 and of at most 1024");
      return std::nullopt;
    }
    choice.threads = whole_number<int>(v.number);
    return choice;
  }
  const std::size_t before = faults.size();
  choice.overrides = read_setting(pointer, slice(v), pointer_at);
  if (faults.size() != before) return std::nullopt;
  return choice;
}

namespace {

/// Whether a pointer leads to the mechanics of a scene and not to the method of computation. The use of parameters is
/// not known here.
bool changes_the_scene(const std::string& pointer) {
  const auto tokens = split_pointer(pointer);
  if (!tokens || tokens->empty()) return false;  // reported as not being a pointer
  const std::string& first = tokens->front();
  if (first == "beams") return tokens->back() != "elements" && tokens->back() != "order";
  if (first == "analysis") return tokens->back() == "end_time" || tokens->back() == "kind" || tokens->back() == "frame";
  return first != "solver" && first != "output" && first != "without" && first != "parameters";
}

}  // namespace

StudyAxis StudyConverter::read_axis(const Value& v, const std::string& at) {
  StudyAxis axis;
  axis.name = v.find("name")->text;
  const auto known =
      std::find_if(known_axes().begin(), known_axes().end(), [&](const KnownAxis& a) { return axis.name == a.name; });
  const bool is_known = known != known_axes().end();
  const Value* given = v.find("pointer");
  if (is_known) axis.larger_is_finer = known->larger_is_finer;
  if (const Value* finer = v.find("finer")) axis.larger_is_finer = finer->text == "larger";
  if (const Value* choices = v.find("choices")) {
    for (std::size_t i = 0; i < choices->items.size(); ++i) {
      const Value& c = choices->items[i];
      const std::string here = at + "/choices/" + std::to_string(i);
      StudyChoice choice;
      choice.at = here;
      choice.label = c.find("label")->text;
      if (const Value* number = c.find("value")) choice.number = number->number;
      choice.overrides = read_settings(*c.find("set"), here + "/set");
      axis.choices.push_back(std::move(choice));
    }
    return axis;
  }
  if (given == nullptr && !is_known) {
    std::vector<std::string> names;
    for (const KnownAxis& a : known_axes()) names.emplace_back(a.name);
    const std::string near = did_you_mean(axis.name, names);
    fault(at + "/name", "no known axis has this name, and there is no pointer that says what it changes",
          near.empty() ? "give a pointer, for instance \"/analysis/step_size\"" : near);
    return axis;
  }
  const std::string pointer = given != nullptr ? given->text.str() : known->pointer;
  if (given != nullptr && changes_the_scene(pointer)) {
    fault(at + "/pointer", "this changes what is computed, and errors compare how the same is computed",
          "bough sweep varies scenes and says what comes of it");
    return axis;
  }
  const Value& values = *v.find("values");
  for (std::size_t i = 0; i < values.items.size(); ++i) {
    auto choice = read_value(axis.name, pointer, values.items[i], at + "/values/" + std::to_string(i),
                             at + (given != nullptr ? "/pointer" : "/name"));
    if (!choice) break;
    axis.choices.push_back(std::move(*choice));
  }
  return axis;
}

void StudyConverter::read_orders(const Value& list, const std::string& at, StudyGrid& grid) {
  std::vector<std::string> names;
  for (const StudyQuantity& q : spec.quantities) names.push_back(q.name);
  for (std::size_t i = 0; i < list.items.size(); ++i) {
    const Value& v = list.items[i];
    const std::string& name = v.find("quantity")->text;
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      fault(at + "/" + std::to_string(i) + "/quantity", "no quantity has this name", did_you_mean(name, names));
      continue;
    }
    grid.orders.push_back({static_cast<std::size_t>(found - names.begin()), v.find("order")->number,
                           v.find("theory")->text, v.find("explanation")->text});
  }
}

/// Sample times are ends of steps.
bool StudyConverter::check_samples(const scene::Scene& scene, const std::string& at) {
  const double end = spec.is_dynamic ? scene.analysis.end_time : 1.0;
  if (scene::type_of(scene.analysis.kind).is_in_time != spec.is_dynamic || end != spec.end) {
    fault(at, "all runs of a study end at the same time");
    return false;
  }
  const double interval = spec.sample_interval > 0.0 ? spec.sample_interval : spec.end;
  const double step = spec.is_dynamic ? scene.analysis.step_size : 1.0 / scene.analysis.load_steps;
  if (is_multiple(interval, step)) return true;
  const std::string rule = "the step size " + rounded_text(step, 9) + " does not divide " +
                           (spec.sample_interval > 0.0 ? "the sample_interval " : "the duration ") +
                           rounded_text(interval, 9);
  const bool was_said = std::any_of(faults.kept().begin(), faults.kept().end(),
                                    [&](const PlacedFault& f) { return f.pointer == at && f.rule == rule; });
  if (!was_said) fault(at, rule, "errors are measured at the ends of steps, without interpolation");
  return false;
}

/// Reads the scene of every run, so that faults are found before the study starts.
void StudyConverter::check_runs(const StudyGrid& grid, const std::string& at) {
  const StudyReference* reference = grid.has_reference   ? &grid.reference
                                    : spec.has_reference ? &spec.reference
                                                         : nullptr;
  constexpr double most_runs = 5000.0;  // each is read and checked before the first starts
  double runs = 1.0;
  for (const StudyAxis& axis : grid.axes) runs *= static_cast<double>(axis.choices.size());
  if (runs > most_runs) {
    fault(at + "/axes", "these axes make " + rounded_text(runs, 6) + " runs, and at most 5000 are taken",
          "give fewer values, or split the grid");
    return;
  }
  for (const StudyQuantity& q : spec.quantities) {
    if (q.is_compared() || reference != nullptr) continue;
    fault("/quantities/" + std::to_string(&q - spec.quantities.data()), "there is nothing to compare it with",
          "give a formula, a table, or a reference of the study");
    return;
  }
  std::vector<SettingOrigin> common = origins_;
  add_origins(grid.overrides, at + "/set", common);
  std::string of_reference;
  if (reference != nullptr) {
    for (const std::vector<std::string>* settings : {&reference->overrides, &reference->check_overrides}) {
      const std::vector<std::string> overrides = overrides_of(spec, grid, *settings);
      const std::string here = reference->at + (settings == &reference->overrides ? "/set" : "/check");
      std::vector<SettingOrigin> origins = common;
      add_origins(*settings, here, origins);
      const auto scene = scene_->read(overrides, origins, here, faults);
      if (!scene || !check_samples(*scene, here)) return;
      const std::string canonical = canonical_scene(spec.scene_text, overrides);
      if (canonical == of_reference) {
        fault(reference->at, "reference and check are the same run", "its error is estimated from their difference");
        return;
      }
      if (of_reference.empty()) of_reference = canonical;
    }
  }
  for (const std::vector<std::size_t>& c : combinations_of(grid)) {
    const std::vector<std::string> overrides = overrides_of(spec, grid, c);
    std::vector<SettingOrigin> origins = common;
    for (std::size_t a = 0; a < c.size(); ++a) {
      const StudyChoice& choice = grid.axes[a].choices[c[a]];
      add_origins(choice.overrides, choice.at, origins);
    }
    const auto scene = scene_->read(overrides, origins, at, faults);
    if (!scene || !check_samples(*scene, grid.axes[grid.abscissa].choices[c[grid.abscissa]].at)) continue;
    if (reference != nullptr && canonical_scene(spec.scene_text, overrides) == of_reference)
      fault(reference->at,
            "one of the runs is the reference itself: that at " + grid.axes[grid.abscissa].choices[c[grid.abscissa]].at,
            "compute the reference by another method or with tighter settings");
  }
}

}  // namespace bough::io
