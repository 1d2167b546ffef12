#include "bough/io/read_scene.hpp"

#include <algorithm>

#include "bough/io/digest.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/schema_rule.hpp"
#include "bough/scene/problems.hpp"
#include "document_report.hpp"
#include "expand_scene.hpp"
#include "printed_json.hpp"
#include "read_scene_impl.hpp"

namespace bough::io {
namespace {

/// True if a fault concerns the outline of the file, which would cause many further reports.
bool breaks_outline(const std::vector<CheckFault>& faults) {
  return std::any_of(faults.begin(), faults.end(), [](const CheckFault& f) {
    const bool is_top = std::count(f.pointer.begin(), f.pointer.end(), '/') <= 1;
    return is_top && f.meant.empty() && f.rule.find("needs the key") == std::string::npos &&
           f.pointer != "/schema_version" && f.pointer != "/gravity" && f.pointer != "/title";
  });
}

void add_scene_problems(const Converter& converter, Report& report) {
  for (const scene::SceneProblem& p : scene::problems_in(converter.scene, converter.defective)) {
    std::string pointer = "/" + p.section;
    if (const auto it = converter.pointers.find(p.section);
        it != converter.pointers.end() && p.index >= 0 && static_cast<std::size_t>(p.index) < it->second.size())
      pointer = it->second[static_cast<std::size_t>(p.index)];
    else if (p.section == "scene")
      pointer = "";
    if (!p.key.empty()) pointer += "/" + p.key;
    PlacedFault f{pointer, p.value, p.rule, p.hint};
    const bool is_name = !f.value.empty() && f.value.find_first_not_of("-+.0123456789eE, ") != std::string::npos;
    if (is_name) f.value = shown_in_quotes(f.value);
    report.add(f, p.is_warning);
    report.count_others(p.more, p.is_warning);
  }
}

/// Numbers of the items of each list of a document.
std::map<std::string, std::size_t, std::less<>> counts_in(const JsonValue& root) {
  std::map<std::string, std::size_t, std::less<>> counts;
  for (std::size_t i = 0; i < root.items.size(); ++i)
    if (root.items[i].is(JsonKind::array)) counts[root.items.key(i)] = root.items[i].items.size();
  return counts;
}

/// A scene and the document that it was read from.
struct ReadScene {
  SceneFile file;
  std::optional<JsonValue> document;
};

ReadScene read(std::string_view text, std::string name, std::span<const std::string> set_overrides,
               const std::filesystem::path& folder) {
  ReadScene result;
  SceneFile& file = result.file;
  std::vector<JsonFault> text_faults;
  std::optional<JsonValue> root = parse_json(text, source_file, text_faults);
  std::vector<std::string> override_texts;
  std::vector<PlacedFault> override_faults;
  std::vector<CheckFault> check_faults;
  std::size_t more_faults = 0;
  Expansion expansion;
  std::string contents;
  if (root) {
    apply_overrides(*root, set_overrides, override_texts, override_faults);
    expansion = expand_scene(*root);
    more_faults = check_rules(scene_rules(), *root, check_faults) + expansion.more_faults;
  }
  Report report(text, root ? &*root : nullptr, override_texts, &expansion.origins);
  for (const JsonFault& f : text_faults) report.add(f);
  for (const PlacedFault& f : override_faults) report.add_override(f);
  for (const ExpansionFault& f : expansion.faults) report.add(f, false);
  for (const ExpansionFault& f : expansion.warnings) report.add(f, true);
  for (const CheckFault& f : check_faults) report.add(f);
  report.count_others(more_faults);
  if (root && root->is(JsonKind::object) && expansion.has_outline && !breaks_outline(check_faults)) {
    Converter converter(*root, folder);
    converter.convert();
    contents = converter.files.contents();
    file.counts = counts_in(*root);
    report.add(converter.faults, false);
    report.add(converter.warnings, true);
    add_scene_problems(converter, report);
    file.scene = std::move(converter.scene);
  }
  file.scene.name = std::move(name);
  file.hash = contents.empty() ? digest_of(text) : digest_of(std::string(text) + contents);
  report.write(file.problems, file.warnings);
  result.document = std::move(root);
  return result;
}

/// The scene with each value of the parameter over which modes are asked for. A fault with one value is a fault of the
/// file.
void read_variants(SceneFile& file, std::string_view text, std::span<const std::string> set_overrides,
                   const std::filesystem::path& folder) {
  scene::CampbellAsked& asked = file.scene.analysis.campbell;
  std::vector<std::string> overrides(set_overrides.begin(), set_overrides.end());
  overrides.emplace_back();
  for (std::size_t k = 0; k < asked.values.size(); ++k) {
    std::string& set = overrides.back() = asked.parameter + "=";
    append_number(set, asked.values[k]);
    ReadScene variant = read(text, file.scene.name, overrides, folder);
    if (variant.file.ok()) {
      asked.scenes.push_back(std::make_shared<const scene::Scene>(std::move(variant.file.scene)));
      continue;
    }
    const Problem& first = variant.file.problems.front();
    Problem problem;
    problem.pointer = "/analysis/values/" + std::to_string(k);
    problem.value = set;
    problem.rule = "the scene with this value is at fault: " + first.text();
    problem.hint = "\"parameter\" is a JSON pointer to a number of the scene, as \"/parameters/speed\"";
    file.problems.push_back(std::move(problem));
    return;
  }
}

/// Calls read_text(text, name) with the text of a file, or reports why it cannot be read.
template <class ReadText>
auto read_file(const std::filesystem::path& file, const ReadText& read_text) {
  Problem problem;
  const std::string text = read_whole_file(file, problem);
  if (problem.rule.empty()) return read_text(text, file == "-" ? "scene" : name_of_file(file));
  decltype(read_text(text, std::string())) r;
  problem.value = shown(file.string(), 200);
  problem.code = "unreadable";
  r.problems.push_back(std::move(problem));
  return r;
}

}  // namespace

SceneFile read_scene_text(std::string_view text, std::string name, std::span<const std::string> set_overrides,
                          const std::filesystem::path& folder) {
  SceneFile file = read(text, std::move(name), set_overrides, folder).file;
  if (file.ok()) read_variants(file, text, set_overrides, folder);
  return file;
}

ExpandedScene expanded_scene_text(std::string_view text, std::span<const std::string> set_overrides,
                                  const std::filesystem::path& folder) {
  ReadScene result = read(text, "", set_overrides, folder);
  ExpandedScene expanded{"", std::move(result.file.problems), std::move(result.file.warnings)};
  if (expanded.ok()) expanded.text = printed(*result.document) + "\n";
  return expanded;
}

namespace {

/// Folder of the files that a scene names; none for a scene from standard input.
std::filesystem::path folder_of(const std::filesystem::path& file) {
  if (file == "-") return {};
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

}  // namespace

std::string name_of_file(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  return stem.find_first_not_of('.') == std::string::npos ? file.filename().string() : stem;
}

SceneFile read_scene(const std::filesystem::path& file, std::span<const std::string> set_overrides) {
  return read_file(file, [&](const std::string& text, std::string name) {
    return read_scene_text(text, std::move(name), set_overrides, folder_of(file));
  });
}

ExpandedScene expanded_scene(const std::filesystem::path& file, std::span<const std::string> set_overrides) {
  return read_file(file, [&](const std::string& text, const std::string&) {
    return expanded_scene_text(text, set_overrides, folder_of(file));
  });
}

}  // namespace bough::io
