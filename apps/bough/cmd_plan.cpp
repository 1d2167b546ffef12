/// bough plan SCENE: what is left out of a run and why, and what the run will take.
#include <cmath>
#include <iostream>
#include <vector>

#include "arguments.hpp"
#include "bough/io/atomic_file.hpp"
#include "bough/io/json_text.hpp"
#include "bough/io/manifest.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/quantity_text.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/run/outlook.hpp"
#include "memory_limit.hpp"
#include "result_text.hpp"
#include "terminal.hpp"

namespace bough::app {
namespace {

using io::bytes_text;
using io::rounded_text;
using io::seconds_text;

/// "45 % less", of what it would be without the decision.
std::string change_text(double with, double without, const char* less, const char* more) {
  if (!(without > 0.0)) return "-";
  const double change = 100.0 * (with / without - 1.0);
  if (std::abs(change) < 0.5) return "the same";
  return rounded_text(std::abs(change), 2) + " % " + (change < 0.0 ? less : more);
}

std::string saving_text(const run::OutlookDecision& d, const run::Effort& now) {
  if (!d.has_saving) return "";
  const run::Effort& other = d.without;
  std::string text;
  if (other.unknowns != now.unknowns)
    text += std::to_string(now.unknowns) + " unknowns instead of " + std::to_string(other.unknowns) + ", ";
  text += "step " + change_text(now.step_seconds(), other.step_seconds(), "shorter", "longer");
  if (other.memory_bytes != now.memory_bytes)
    text += ", memory " +
            change_text(static_cast<double>(now.memory_bytes), static_cast<double>(other.memory_bytes), "less", "more");
  return text;
}

std::string count_text(int number, const char* one, const char* many) {
  return std::to_string(number) + " " + (number == 1 ? one : many);
}

/// "1 of 'crank', 'coupler' and 1 more: its joints leave 3, closing their loops takes 2 (5 conditions)"
std::string mobility_text(const plan::MobilityPart& p) {
  std::string text = std::to_string(p.degrees_of_freedom()) + " of ";
  constexpr std::size_t shown = 3;
  for (std::size_t i = 0; i < std::min(shown, p.names.size()); ++i) text += (i > 0 ? ", '" : "'") + p.names[i] + "'";
  if (p.names.size() > shown) text += " and " + std::to_string(p.names.size() - shown) + " more";
  if (!p.reaches_ground) text += ", which nothing joins to the ground";
  if (p.closing_rows > 0)
    text += ": joints leave " + std::to_string(p.freedoms) + ", closing loops takes " + std::to_string(p.rank) +
            (p.is_counted ? " (" + count_text(p.closing_rows, "condition", "conditions") + ")"
                          : " at most (" + count_text(p.closing_rows, "condition", "conditions") + ", rank not found)");
  if (p.drives > 0) text += "; " + count_text(p.drives, "is driven", "are driven");
  return text;
}

std::string mobility_text(const plan::Mobility& m) {
  constexpr std::size_t shown = 6;
  bool has_beams = false;
  for (const plan::MobilityPart& p : m.parts) has_beams |= p.has_beams;
  std::string text = "degrees of freedom of the mechanism: " + std::to_string(m.degrees_of_freedom()) + " in all" +
                     (has_beams ? ", beams taken as rigid" : "") + "\n";
  for (std::size_t i = 0; i < std::min(shown, m.parts.size()); ++i) text += "  " + mobility_text(m.parts[i]) + "\n";
  if (m.parts.size() > shown) text += "  and " + std::to_string(m.parts.size() - shown) + " more parts\n";
  return text;
}

std::string plan_text(const run::Outlook& o) {
  const run::Effort& e = o.effort;
  std::string text = o.scene + (o.title.empty() ? "" : ": " + o.title) + "\n\n";
  text += std::to_string(o.nodes) + " nodes, " + std::to_string(o.elements) + " elements, " + std::to_string(o.joints) +
          " joints; moves " + o.motions + "\n";
  text += mobility_text(o.mobility);
  text += std::to_string(e.unknowns) + " unknowns";
  if (e.unknowns != o.unknowns_in_space) text += " of " + std::to_string(o.unknowns_in_space);
  text += "; " + std::to_string(o.sub_domains) + " sub-domains, " + std::to_string(o.leaves) + " leaves, " +
          std::to_string(o.levels) + " levels (" + o.cut + "), " + std::to_string(o.fronts_in_lanes) + " of " +
          std::to_string(o.fronts) + " fronts in lockstep\n";
  text += "a step, about " + seconds_text(e.step_seconds()) + " on one thread: elements " +
          seconds_text(e.evaluate_seconds) + ", factor " + seconds_text(e.factor_seconds) + " (" +
          rounded_text(e.factorizations, 2) +
          (e.factor_flops > 0.0 ? " of " + rounded_text(1e-6 * e.factor_flops, 3) + " Mflop" : "") + "), solve " +
          seconds_text(e.solve_seconds) + ", nodes " + seconds_text(e.other_seconds) + "\n";
  text +=
      "  by " + rounded_text(e.iterations, 2) + " iterations, " + rounded_text(e.evaluations, 2) + " evaluations and " +
      rounded_text(e.factorizations, 2) + " factorizations a step, " +
      (e.trial_steps > 0 ? "counted and timed over the later half of " + std::to_string(e.trial_steps) + " trial steps"
                         : std::string("as is usual; times by a model")) +
      "\n";
  text += "a run, " + rounded_text(o.steps, 6) + (o.steps == 1.0 ? " step" : " steps") + ", about " +
          seconds_text(o.steps * e.step_seconds()) + " on one thread\n";
  for (const run::OutlookTwin& t : o.twins)
    text += "beside it, for its errors, " + t.what + ": about " + seconds_text(t.seconds) + " on one thread, " +
            bytes_text(t.memory_bytes) + "\n";
  text += "memory, about " + bytes_text(static_cast<double>(o.process_bytes)) + ", of which " +
          bytes_text(static_cast<double>(e.memory_bytes)) + " for the scene\n\n";
  std::vector<std::vector<std::string>> rows{{"decision", "", "with it", "because"}};
  for (const run::OutlookDecision& d : o.decisions)
    rows.push_back({d.decision.name,
                    d.decision.taken    ? "taken"
                    : d.decision.barred ? "barred"
                                        : "-",
                    saving_text(d, e), d.decision.reason});
  text += table_text(rows);
  for (const std::string& note : o.notes) text += "note: " + note + "\n";
  return text;
}

void write_effort(io::JsonText& json, const run::Effort& e) {
  json.begin_object();
  json.member("unknowns", static_cast<long long>(e.unknowns));
  json.member("factor_flops", e.factor_flops);
  json.member("factorizations", e.factorizations);
  json.member("iterations", e.iterations);
  json.member("evaluations", e.evaluations);
  json.member("trial_steps", static_cast<long long>(e.trial_steps));
  json.member("evaluate_s", e.evaluate_seconds);
  json.member("factor_s", e.factor_seconds);
  json.member("solve_s", e.solve_seconds);
  json.member("other_s", e.other_seconds);
  json.member("step_s", e.step_seconds());
  json.member("model_step_s", e.model_seconds);
  json.member("memory_bytes", static_cast<long long>(e.memory_bytes));
  json.end_object();
}

void write_mobility(io::JsonText& json, const plan::Mobility& m) {
  json.begin_object();
  json.member("degrees_of_freedom", static_cast<long long>(m.degrees_of_freedom()));
  json.key("parts");
  json.begin_array();
  for (const plan::MobilityPart& p : m.parts) {
    json.begin_object();
    json.key("names");
    json.begin_array();
    for (const std::string& name : p.names) json.value(name);
    json.end_array();
    json.member("degrees_of_freedom", static_cast<long long>(p.degrees_of_freedom()));
    json.member("joints", static_cast<long long>(p.joints));
    json.member("freedoms", static_cast<long long>(p.freedoms));
    json.member("closing_conditions", static_cast<long long>(p.closing_rows));
    json.member("rank", static_cast<long long>(p.rank));
    json.member("rank_is_found", p.is_counted);
    json.member("drives", static_cast<long long>(p.drives));
    json.member("has_beams", p.has_beams);
    json.member("reaches_ground", p.reaches_ground);
    json.end_object();
  }
  json.end_array();
  json.end_object();
}

std::string plan_json(const run::Outlook& o, const std::vector<io::Problem>& hints) {
  io::JsonText json;
  json.begin_object();
  json.member("scene", o.scene);
  json.member("title", o.title);
  json.member("nodes", static_cast<long long>(o.nodes));
  json.member("elements", static_cast<long long>(o.elements));
  json.member("joints", static_cast<long long>(o.joints));
  json.member("motions", o.motions);
  json.member("unknowns_in_space", static_cast<long long>(o.unknowns_in_space));
  json.member("cut", o.cut);
  json.member("sub_domains", static_cast<long long>(o.sub_domains));
  json.member("leaves", static_cast<long long>(o.leaves));
  json.member("levels", static_cast<long long>(o.levels));
  json.member("fronts", static_cast<long long>(o.fronts));
  json.member("fronts_in_lanes", static_cast<long long>(o.fronts_in_lanes));
  json.member("steps", o.steps);
  json.member("process_bytes", static_cast<long long>(o.process_bytes));
  json.key("mobility");
  write_mobility(json, o.mobility);
  json.key("step");
  write_effort(json, o.effort);
  json.key("decisions");
  json.begin_array();
  for (const run::OutlookDecision& d : o.decisions) {
    json.begin_object();
    json.member("name", d.decision.name);
    json.member("taken", d.decision.taken);
    json.member("barred", d.decision.barred);
    json.member("can_be_barred", d.decision.can_be_barred);
    json.member("what", d.decision.what);
    json.member("reason", d.decision.reason);
    if (d.has_saving) {
      json.key("step_without");
      write_effort(json, d.without);
    }
    json.end_object();
  }
  json.end_array();
  json.key("twins");
  json.begin_array();
  for (const run::OutlookTwin& t : o.twins) {
    json.begin_object();
    json.member("what", t.what);
    json.member("time_s", t.seconds);
    json.member("memory_bytes", t.memory_bytes);
    json.end_object();
  }
  json.end_array();
  json.key("notes");
  json.begin_array();
  for (const std::string& note : o.notes) json.value(note);
  json.end_array();
  json.key("hints");  // of the check: legal, but hardly meant
  json.begin_array();
  for (const io::Problem& hint : hints) json.value(hint.text());
  json.end_array();
  json.end_object();
  return json.text();
}

}  // namespace

int plan(const PlanArguments& arguments) {
  const io::SceneFile file = io::read_scene(arguments.scene, arguments.overrides);
  print_problems(arguments.scene, file, false);
  if (!file.ok()) return exit_bad_input;
  io::refuse_to_overwrite({arguments.scene}, {arguments.json});
  if (refuse_for_memory(arguments.scene, file.scene, arguments.memory_limit)) return exit_bad_input;
  const run::Outlook outlook = run::look_ahead(file.scene);
  try {
    if (!arguments.json.empty()) io::write_file(arguments.json, plan_json(outlook, file.warnings));
  } catch (const std::exception& error) {
    std::cerr << "bough: " << cause_of(error) << "\n";
    return exit_failed;
  }
  std::cout << plan_text(outlook) << std::flush;
  return exit_done;
}

}  // namespace bough::app
