#include "bough/io/read_sweep.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "bough/io/csv_table.hpp"
#include "bough/io/json_text.hpp"
#include "bough/io/number_text.hpp"
#include "bough/laws/law_error.hpp"
#include "document_report.hpp"
#include "named_numbers.hpp"
#include "scene_converter.hpp"
#include "sweep_rules.hpp"

namespace bough::io {
namespace {

class SweepConverter : public SceneConverter {
 public:
  SweepSpec spec;

  SweepConverter(std::string_view text, std::filesystem::path folder) : SceneConverter(text, std::move(folder)) {}

  void convert(const JsonValue& root) {
    spec.title = text_or(root, "title");
    const std::optional<std::filesystem::path> scene_file = read_scene_file(root, spec.scene_text, spec.scene_name);
    if (!scene_file) return;
    spec.scene_file = scene_file->string();
    read_settings(root);
    read_measures(root);
    const Value* designs = root.find("designs");
    if (designs == nullptr || !designs->sound) return;
    for (std::size_t i = 0; i < designs->items.size(); ++i)
      read_design(designs->items[i], "/designs/" + std::to_string(i));
    if (const Value* where = root.find("where"); where != nullptr && where->sound)
      for (std::size_t i = 0; i < where->items.size(); ++i)
        read_condition(where->items[i], "/where/" + std::to_string(i));
    if (faults.empty()) read_some_case();
  }

 private:
  void read_settings(const Value& root) {
    const Value* set = root.find("set");
    if (set == nullptr || !set->sound) return;
    for (std::size_t i = 0; i < set->items.size(); ++i) {
      const std::string at = "/set/" + std::to_string(i);
      for (std::string& o : pointers_of(set->items[i].find("pointer")->text, slice(*set->items[i].find("value")), at))
        spec.overrides.push_back(std::move(o));
    }
  }

  /// Whether the tables of a batch have a column of this name for every case.
  static bool is_column_of_tables(const std::string& name) {
    constexpr std::array names = {
        "case",           "status",         "cause",  "steps_accepted", "steps_rejected",   "newton_iterations",
        "expected_holds", "expected_fails", "doubts", "energy_error",   "constraint_error", "machine"};
    return std::any_of(names.begin(), names.end(), [&](const char* column) { return name == column; });
  }
  static constexpr const char* column_rule = "the tables of a batch have a column of this name already";

  /// "/pointer=value" for all that a pointer names.
  std::vector<std::string> pointers_of(const std::string& pointer, const std::string& value, const std::string& at) {
    std::vector<std::string> list = read_setting(pointer, value, at + "/pointer");
    for (const std::string& o : list) origins_.push_back({o.substr(0, o.find('=')), at});
    return list;
  }

  /// Reads measures; the scene's own ones are kept and come before those of the sweep.
  void read_measures(const Value& root) {
    const Value* measures = root.find("measures");
    if (measures == nullptr || !measures->sound || measures->items.empty()) return;
    std::vector<JsonFault> text_faults;
    const std::optional<JsonValue> scene = parse_json(spec.scene_text, source_file, text_faults);
    std::string all;
    if (const Value* own = scene ? scene->find("measures") : nullptr; own != nullptr && own->is(JsonKind::array))
      for (const Value& m : own->items) all += (all.empty() ? "" : ", ") + spec.scene_text.substr(m.offset, m.length);
    for (std::size_t i = 0; i < measures->items.size(); ++i) {
      const Value& m = measures->items[i];
      all += (all.empty() ? "" : ", ") + slice(m);
      if (m.sound && is_column_of_tables(m.find("name")->text))
        fault("/measures/" + std::to_string(i) + "/name", column_rule);
    }
    spec.overrides.push_back("/measures=[" + all + "]");
    origins_.push_back({"/measures", "/measures"});
  }

  SweepValue value_of(const Value& v) const {
    SweepValue value{v.is(JsonKind::string) ? json_string(v.text.str()) : slice(v), {}};
    for (char& c : value.text)
      if (c == '\n' || c == '\r') c = ' ';  // between values of a list: tables have one line a case
    if (v.is(JsonKind::number)) value.number = v.number;
    return value;
  }

  SweepVariable read_variable(const Value& v, const std::string& at) {
    SweepVariable variable;
    variable.name = v.find("name")->text;
    if (!names_.insert(variable.name).second)
      fault(at + "/name", "another variable has this name", "names are used once");
    if (is_column_of_tables(variable.name)) fault(at + "/name", column_rule);
    const Value* pointer = v.find("pointer");
    const std::string where = pointer == nullptr ? pointer_to("/parameters", variable.name) : pointer->text.str();
    for (const std::string& o : pointers_of(where, "", at)) variable.pointers.push_back(o.substr(0, o.find('=')));
    if (const Value* values = v.find("values"))
      for (const Value& x : values->items) variable.values.push_back(value_of(x));
    if (const Value* nominal = v.find("nominal")) variable.nominal = value_of(*nominal);
    if (const Value* d = v.find("distribution")) variable.distribution = read_distribution(*d, at + "/distribution");
    return variable;
  }

  SweepDistribution read_distribution(const Value& v, const std::string& at) {
    SweepDistribution d;
    const std::string& kind = v.find("kind")->text;
    if (kind == "uniform") {
      d.low = number_or(v, "low", 0.0);
      d.high = number_or(v, "high", 1.0);
      if (!(d.low < d.high)) fault(at + "/high", "has to be above \"low\"");
    } else if (kind == "discrete") {
      d.kind = SweepDistribution::Kind::discrete;
      for (const Value& x : v.find("values")->items) d.values.push_back(x.number);
      if (const Value* weights = v.find("weights")) {
        for (const Value& x : weights->items) d.weights.push_back(x.number);
        double sum = 0.0;
        for (const double w : d.weights) sum += w;
        if (d.weights.size() != d.values.size()) fault(at + "/weights", "as many weights as values are needed");
        if (!(sum > 0.0) || !std::isfinite(sum))
          fault(at + "/weights", "the sum of the weights has to be above 0, and finite");
      }
    } else {
      const bool is_log = kind == "lognormal";
      d.kind = is_log ? SweepDistribution::Kind::lognormal : SweepDistribution::Kind::normal;
      d.mean = number_or(v, is_log ? "log_mean" : "mean", 0.0);
      d.deviation = number_or(v, is_log ? "log_standard_deviation" : "standard_deviation", 1.0);
    }
    return d;
  }

  void read_design(const Value& v, const std::string& at) {
    static const char* const kinds[] = {"list",  "csv",    "grid",    "one_at_a_time", "random", "latin_hypercube",
                                        "sobol", "morris", "saltelli"};
    SweepDesign design;
    for (int k = 0; k <= static_cast<int>(SweepDesignKind::saltelli); ++k)
      if (v.find("kind")->text == kinds[k]) design.kind = static_cast<SweepDesignKind>(k);
    const Value& variables = *v.find("variables");
    for (std::size_t i = 0; i < variables.items.size(); ++i)
      design.variables.push_back(read_variable(variables.items[i], at + "/variables/" + std::to_string(i)));
    const bool is_morris = design.kind == SweepDesignKind::morris;
    design.samples = whole_number<std::uint32_t>(number_or(v, is_morris ? "trajectories" : "samples", 0.0));
    design.seed = whole_number<std::uint64_t>(number_or(v, "seed", 1.0));
    design.levels = whole_number<int>(number_or(v, "levels", 4.0));
    if (design.levels % 2 != 0)
      fault(at + "/levels", "has to be even: steps of levels/2 then meet all levels equally often");
    const std::size_t most = design.kind == SweepDesignKind::sobol      ? 21
                             : design.kind == SweepDesignKind::saltelli ? 10
                                                                        : 100;
    if (design.variables.size() > most)
      fault(at + "/variables", "this design takes at most " + std::to_string(most) + " variables");
    if (design.kind == SweepDesignKind::list) read_rows(*v.find("rows"), at + "/rows", design);
    if (design.kind == SweepDesignKind::csv) read_table(v, at, design);
    spec.designs.push_back(std::move(design));
  }

  void read_rows(const Value& rows, const std::string& at, SweepDesign& design) {
    for (std::size_t r = 0; r < rows.items.size(); ++r) {
      const Value& row = rows.items[r];
      if (row.items.size() != design.variables.size())
        return fault(at + "/" + std::to_string(r), "has " + std::to_string(row.items.size()) +
                                                       " values, and there are " +
                                                       std::to_string(design.variables.size()) + " variables");
      for (std::size_t k = 0; k < row.items.size(); ++k) design.variables[k].values.push_back(value_of(row.items[k]));
    }
  }

  void read_table(const Value& v, const std::string& at, SweepDesign& design) {
    Problem problem;
    const std::string text = read_whole_file(path_of(v.find("file")->text.str()), problem);
    CsvTable table;
    const std::string rule = problem.rule.empty() ? table.read(text) : problem.rule;
    if (!rule.empty()) return fault(at + "/file", rule, "names are relative to the sweep's folder");
    if (table.rows.empty()) return fault(at + "/file", "the table has no rows");
    const Value& variables = *v.find("variables");
    for (std::size_t i = 0; i < variables.items.size(); ++i) {
      const Value* given = variables.items[i].find("column");
      const std::string& name = given == nullptr ? design.variables[i].name : given->text.str();
      const auto column = std::find(table.columns.begin(), table.columns.end(), name);
      if (column != table.columns.end() && std::find(column + 1, table.columns.end(), name) != table.columns.end())
        fault(at + "/file", "the table has two columns \"" + shown(name) + "\"");
      if (column == table.columns.end()) {
        fault(at + "/variables/" + std::to_string(i), "the table has no column \"" + shown(name) + "\"");
        continue;
      }
      for (const std::vector<std::string>& row : table.rows) {
        const std::string& cell = row[static_cast<std::size_t>(column - table.columns.begin())];
        double x = 0.0;
        const bool is_number = read_number(cell, x) && std::isfinite(x);
        SweepValue value{is_number ? std::string() : json_string(cell), {}};
        if (is_number) {
          append_number(value.text, x);
          value.number = x;
        }
        design.variables[i].values.push_back(std::move(value));
      }
    }
  }

  void read_condition(const Value& v, const std::string& at) {
    std::vector<std::string> names;
    for (const SweepDesign& d : spec.designs)
      for (const SweepVariable& x : d.variables)
        if (NamedNumbers::fault_of_name(x.name).empty()) names.push_back(x.name);
    const std::string text = v.find("expression")->text;
    const Value *low = v.find("low"), *high = v.find("high");
    if (low == nullptr && high == nullptr) fault(at, "needs \"low\", \"high\" or both");
    const auto optional = [](const Value* x) { return x == nullptr ? std::nullopt : std::optional<double>(x->number); };
    try {
      spec.where.push_back({text, laws::Formula(text, names), names, optional(low), optional(high)});
    } catch (const laws::LawError& e) {
      fault(at + "/expression", e.what(), "variables may be named, where their names are those of formulas");
    }
  }

  /// Faults of the scene and of pointers show with any values; a value at fault is the fault of its own cases, which
  /// tell it where they run. Values after the first ones are therefore tried, one variable after the other, as long as
  /// they leave fewer faults. If none is without any, the faults of the first values are told.
  void read_some_case() {
    std::vector<const SweepVariable*> variables;
    for (const SweepDesign& d : spec.designs)
      for (const SweepVariable& v : d.variables) variables.push_back(&v);
    std::vector<std::size_t> chosen(variables.size(), 0);
    const std::vector<std::string> first = overrides_with(variables, chosen);
    std::size_t fewest = scene_->num_problems(first);
    int tries = 0;
    for (std::size_t k = 0; k < variables.size() && fewest > 0; ++k) {
      std::size_t best = 0;
      for (std::size_t i = 1; i < variables[k]->values.size() && fewest > 0 && ++tries <= most_tries; ++i) {
        chosen[k] = i;
        const std::size_t number = scene_->num_problems(overrides_with(variables, chosen));
        if (number < fewest) best = i;
        fewest = std::min(fewest, number);
      }
      chosen[k] = best;
    }
    if (fewest > 0) (void)scene_->read(first, origins_, "/scene", faults);
  }

  std::vector<std::string> overrides_with(const std::vector<const SweepVariable*>& variables,
                                          const std::vector<std::size_t>& chosen) const {
    std::vector<std::string> overrides = spec.overrides;
    for (std::size_t k = 0; k < variables.size(); ++k) {
      const SweepVariable& v = *variables[k];
      const bool draws = v.values.empty();
      std::string value = draws ? "" : v.values[chosen[k]].text;
      if (draws) append_number(value, typical(v.distribution));
      for (const std::string& pointer : v.pointers) overrides.push_back(pointer + "=" + value);
    }
    return overrides;
  }

  static double typical(const SweepDistribution& d) {
    switch (d.kind) {
      case SweepDistribution::Kind::uniform:
        return 0.5 * d.low + 0.5 * d.high;
      case SweepDistribution::Kind::normal:
        return d.mean;
      case SweepDistribution::Kind::lognormal:
        return std::exp(d.mean);
      case SweepDistribution::Kind::discrete:
        break;
    }
    return d.values.front();
  }

  static constexpr int most_tries = 100;  ///< readings of the scene
  std::set<std::string> names_;
};

}  // namespace

SweepFile read_sweep_text(std::string_view text, std::string name, const std::filesystem::path& folder) {
  SweepFile file;
  SweepConverter converter(text, folder);
  read_document(text, sweep_rules(), converter, file);
  file.spec = std::move(converter.spec);
  file.spec.name = std::move(name);
  return file;
}

SweepFile read_sweep(const std::filesystem::path& file) {
  return read_document_file<SweepFile>(
      file, [&](const std::string& text) { return read_sweep_text(text, name_of_file(file), file.parent_path()); });
}

}  // namespace bough::io
