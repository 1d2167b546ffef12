#include "bough/report/profile_page.hpp"

#include <algorithm>
#include <cmath>

#include "bough/io/number_text.hpp"
#include "bough/io/quantity_text.hpp"
#include "bough/report/document.hpp"
#include "profile_parts.hpp"

namespace bough::report {

namespace {

using io::amount_text;
using io::bytes_text;
using io::seconds_text;
using records::Profile;

Cell seconds_cell(double seconds, std::string source) {
  return {seconds_text(seconds), Tone::plain, true, std::move(source)};
}
Cell amount_cell(double amount, std::string source) {
  return {amount_text(amount), Tone::plain, true, std::move(source)};
}
Cell count_cell(std::int64_t count, std::string source) {
  return {std::to_string(count), Tone::plain, true, std::move(source)};
}

std::vector<Cell> time_cells(const records::SubdomainTimes& t, const std::string& source) {
  std::vector<Cell> cells;
  const std::pair<double, const char*> parts[] = {
      {t.evaluate, "evaluate"}, {t.assemble, "assemble"}, {t.factor, "factor"},
      {t.condense, "condense"}, {t.forward, "forward"},   {t.backward, "backward"},
      {t.move, "move"},         {t.residual, "residual"}, {t.wait, "wait"}};
  for (const auto& [seconds, key] : parts) cells.push_back(seconds_cell(seconds, source + "/seconds/" + key));
  return cells;
}

const std::vector<std::string> time_head = {"evaluate",        "assemble",   "factor", "condense", "forward",
                                            "back-substitute", "move nodes", "check",  "wait"};

void add_levels(Document& page, const Profile& p) {
  Table table{{"level", "sub-domains", "unknowns", "interface, most", "fill", "flops", "bytes"}, {}};
  table.head.insert(table.head.end(), time_head.begin(), time_head.end());
  table.head.insert(table.head.end(), {"condition, most"});
  for (const records::LevelProfile& l : p.levels) {
    const std::string source = "/levels/" + std::to_string(l.level);
    std::vector<Cell> row{count_cell(l.level, source + "/level"),
                          count_cell(l.num_subdomains, source + "/sub_domains"),
                          count_cell(l.num_unknowns, source + "/unknowns"),
                          count_cell(l.interface_unknowns_most, source + "/interface_unknowns_max"),
                          amount_cell(static_cast<double>(l.fill), source + "/fill"),
                          amount_cell(l.flops, source + "/flops"),
                          {bytes_text(l.bytes), Tone::plain, true, source + "/bytes"}};
    for (Cell& c : time_cells(l.times, source)) row.push_back(std::move(c));
    row.push_back(number_cell(l.condition_most, 3, source + "/condition_max"));
    table.rows.push_back(std::move(row));
  }
  table.caption = "Sums over the sub-domains of each level (wait: the longest). Level 0 is the root.";
  page.table(table);
}

void add_costliest(Document& page, const Profile& p) {
  constexpr std::size_t most = 20;
  std::vector<const records::SubdomainProfile*> order;
  for (const auto& s : p.subdomains) order.push_back(&s);
  std::stable_sort(order.begin(), order.end(),
                   [](const auto* a, const auto* b) { return a->times.solver() > b->times.solver(); });
  order.resize(std::min(order.size(), most));
  Table table{
      {"sub-domain", "path", "level", "visit", "thread", "elements", "unknowns", "interface", "fill", "flops", "bytes"},
      {}};
  table.head.insert(table.head.end(), time_head.begin(), time_head.end());
  table.head.insert(table.head.end(), {"condition", "largest force at the interface, N", "moment, N m"});
  for (const records::SubdomainProfile* s : order) {
    const std::string source = "/sub_domains/" + std::to_string(s->id);
    std::vector<Cell> row{count_cell(s->id, source + "/id"),
                          {s->path, Tone::plain, false, source + "/path"},
                          count_cell(s->level, source + "/level"),
                          count_cell(s->visit, source + "/visit"),
                          count_cell(s->thread, source + "/thread"),
                          count_cell(s->num_elements, source + "/elements"),
                          count_cell(s->num_unknowns, source + "/unknowns"),
                          count_cell(s->interface_unknowns, source + "/interface_unknowns"),
                          amount_cell(static_cast<double>(s->fill), source + "/fill"),
                          amount_cell(s->flops, source + "/flops"),
                          {bytes_text(s->bytes), Tone::plain, true, source + "/bytes"}};
    for (Cell& c : time_cells(s->times, source)) row.push_back(std::move(c));
    row.push_back(number_cell(s->condition, 3, source + "/condition"));
    row.push_back(number_cell(s->largest_force(), 3));
    row.push_back(number_cell(s->largest_moment(), 3));
    table.rows.push_back(std::move(row));
  }
  table.caption =
      "The " + std::to_string(order.size()) + " of " + std::to_string(p.subdomains.size()) +
      " sub-domains that cost most; all of them are in profile.json. A sensor of kind interface_force takes their "
      "path and a node; forces are those of the last step.";
  page.table(table);
}

/// The walks, each by its schedule and by its bytes.
void add_walks(Document& page, const Profile& p) {
  if (p.walks.empty()) return;
  Table table{{"walk", "critical path", "bytes"}, {}};
  for (const records::ThreadsProfile& t : p.speed)
    table.head.push_back(std::to_string(t.threads) + (t.threads == 1 ? " thread" : " threads"));
  for (std::size_t w = 0; w < p.walks.size(); ++w) {
    const records::WalkProfile& walk = p.walks[w];
    const std::string source = "/solution/walks/" + std::to_string(w);
    std::vector<Cell> schedule{{std::string(walk.work) + ", schedule of its visits"},
                               seconds_cell(walk.critical_path, source + "/critical_path"),
                               {bytes_text(walk.bytes), Tone::plain, true, source + "/bytes"}};
    std::vector<Cell> memory{{std::string(walk.work) + ", reading its bytes"}, {""}, {""}};
    for (std::size_t k = 0; k < walk.seconds.size(); ++k) {
      schedule.push_back(seconds_cell(walk.seconds[k], source + "/seconds/" + std::to_string(k)));
      memory.push_back(seconds_cell(walk.memory_seconds[k], source + "/memory_seconds/" + std::to_string(k)));
    }
    table.rows.push_back(std::move(schedule));
    table.rows.push_back(std::move(memory));
  }
  std::string rates;
  for (const records::ThreadsProfile& t : p.speed)
    if (t.threads <= p.machine_threads || t.threads == 1)
      rates += (rates.empty() ? "" : ", ") + io::bytes_text(t.read_rate) + "/s by " + std::to_string(t.threads) +
               (t.threads == 1 ? " thread" : " threads");
  table.caption =
      "No walk is shorter than the longer one of its two lines. An array as large as all factors and element matrices "
      "is read at " +
      rates + " of this machine; for more threads the rate of all it has is taken.";
  page.table(table);
}

void add_speed(Document& page, const Profile& p) {
  if (p.speed.empty()) return;
  const records::ThreadsProfile& one = p.speed.front();
  Table table{{"threads", "solution, predicted", "with memory", "measured", "speed-up, predicted", "measured",
               "step, predicted", "measured", "speed-up, predicted", "measured"},
              {}};
  Chart chart{"Speed-up of one factorization and solution", {"threads", Scale::log}, {"speed-up", Scale::log}, {}};
  ChartSeries predicted{"predicted", {}}, with_memory{"predicted, with memory", {}}, measured{"measured", {}};
  for (std::size_t k = 0; k < p.speed.size(); ++k) {
    const records::ThreadsProfile& t = p.speed[k];
    const std::string source = "/solution/threads/" + std::to_string(k);
    table.rows.push_back(
        {count_cell(t.threads, source + "/threads"), seconds_cell(t.predicted, source + "/predicted"),
         seconds_cell(t.predicted_with_memory, source + "/predicted_with_memory"),
         seconds_cell(t.measured, source + "/measured"), number_cell(one.predicted / t.predicted, 3),
         number_cell(one.measured / t.measured, 3), seconds_cell(t.predicted_step, source + "/predicted_step"),
         seconds_cell(t.measured_step, source + "/measured_step"),
         number_cell(one.predicted_step / t.predicted_step, 3), number_cell(one.measured_step / t.measured_step, 3)});
    if (t.predicted > 0.0) predicted.points.push_back({static_cast<double>(t.threads), one.predicted / t.predicted});
    if (!std::isnan(t.predicted_with_memory) && t.predicted_with_memory > 0.0)
      with_memory.points.push_back({static_cast<double>(t.threads), one.predicted / t.predicted_with_memory});
    if (!std::isnan(t.measured) && t.measured > 0.0)
      measured.points.push_back({static_cast<double>(t.threads), one.measured / t.measured});
  }
  chart.series = {predicted, with_memory, measured};
  chart.slopes = {{1.0, 1.0, 1.0, "ideal"}};
  page.section("Threads", "threads");
  page.paragraph(
      "One factorization and solution takes " + seconds_text(p.total) +
      " summed over all visits; the longest chain of visits that wait for each other takes " +
      seconds_text(p.critical_path) + ", so no number of threads gains more than " +
      io::rounded_text(p.critical_path > 0.0 ? p.total / p.critical_path : 1.0, 3) +
      ". Predictions schedule the visits as timed on one thread, as the tasks that the program makes; "
      "handing over between threads costs nothing there, and a front that several threads can share counts as "
      "work of one. With memory: each walk takes at least as long as reading its factors and element "
      "matrices. Measured up to the " +
      std::to_string(p.machine_threads) + " threads of this machine.");
  page.table(table);
  page.charts({chart});
  add_walks(page, p);
}

void add_alternatives(Document& page, const Profile& p) {
  if (p.alternatives.empty()) return;
  page.section("Other trees", "trees");
  std::string fit;
  for (const records::CostFit& c : p.costs)
    if (c.num_visits > 0)
      fit += (fit.empty() ? "" : "; ") + std::to_string(c.num_visits) + (c.in_lanes ? " in lockstep" : " alone") +
             " are met to " + io::rounded_text(100.0 * c.median_error, 2) + " % (median)";
  page.paragraph("Predicted by a cost of visits, fitted to those of this run (" + fit +
                 "). bough tune measures instead.");
  Table table{{"", "leaf_size", "depth", "sub-domains", "leaves", "levels", "flops", "1 thread",
               std::to_string(p.threads) + (p.threads == 1 ? " thread" : " threads")},
              {}};
  for (std::size_t k = 0; k < p.alternatives.size(); ++k) {
    const records::Alternative& a = p.alternatives[k];
    const std::string source = "/alternatives/" + std::to_string(k);
    table.rows.push_back({{a.is_present ? "present" : ""},
                          {a.leaf_size == 0 ? "chosen" : std::to_string(a.leaf_size), Tone::plain, true},
                          {a.depth < 0 ? "chosen" : std::to_string(a.depth), Tone::plain, true},
                          count_cell(a.num_subdomains, source + "/sub_domains"),
                          count_cell(a.num_leaves, source + "/leaves"),
                          count_cell(a.num_levels, source + "/levels"),
                          amount_cell(a.flops, source + "/flops"),
                          seconds_cell(a.predicted, source + "/predicted_1_thread"),
                          seconds_cell(a.predicted_threads, source + "/predicted")});
  }
  page.table(table);
}

void add_step(Document& page, const Profile& p) {
  const records::StepProfile& s = p.step;
  Table table{{"step", "upward, factor", "upward", "downward", "check", "evaluation alone", "loops", "rest, serial"},
              {{seconds_cell(s.total, "/step/total"), seconds_cell(s.factor, "/step/factor"),
                seconds_cell(s.forward, "/step/forward"), seconds_cell(s.backward, "/step/backward"),
                seconds_cell(s.residual, "/step/residual"), seconds_cell(s.evaluate, "/step/evaluate"),
                seconds_cell(s.other_chunks, "/step/other_chunks"), seconds_cell(s.rest, "/step/rest")},
               {number_cell(s.walks, 3, "/step/walks"),
                number_cell(s.factorizations, 3, "/step/factorizations"),
                number_cell(s.condensations, 3, "/step/condensations"),
                number_cell(s.solutions, 3, "/step/solutions"),
                number_cell(s.checks, 3, "/step/checks"),
                number_cell(s.evaluations, 3, "/step/evaluations"),
                {},
                {}}}};
  table.caption =
      "One step: the median, the means of what its walks take (wall time), and the rest, which is what these leave of "
      "the median: all that runs outside of the walks, recording included. Second row: the number of walks over the "
      "sub-domains a step, all of them and by kind. On the way up each sub-domain evaluates its elements and condenses "
      "its right-hand side, with a factorization its matrix as well; on the way down it substitutes and moves its "
      "nodes.";
  page.table(table);
}

}  // namespace

std::string profile_page(const Profile& p, const std::string& data) {
  Document page("Profile of " + p.scene, p.title, data);
  if (!p.trouble.empty()) page.paragraph("The run ended early: " + p.trouble, Tone::bad);
  const records::SubdomainProfile* root = p.subdomains.empty() ? nullptr : &p.subdomains.back();
  if (root != nullptr)
    page.paragraph(std::to_string(root->subtree_unknowns) + " unknowns in " + std::to_string(p.subdomains.size()) +
                   " sub-domains on " + std::to_string(p.levels.size()) + " levels, " + std::to_string(p.num_in_lanes) +
                   " of them in lockstep, in " + std::to_string(p.num_visits) + " visits (" + p.cut + "), form \"" +
                   p.form + "\". " + std::to_string(p.steps) + (p.steps == 1 ? " step, " : " steps, ") +
                   std::to_string(p.factorizations) + " factorizations, " + std::to_string(p.threads) +
                   (p.threads == 1 ? " thread." : " threads."));
  if (p.speed.empty() && p.trouble.empty())
    page.paragraph("The form \"" + p.form + "\" walks no sub-domains: only the step and its parts are timed.",
                   Tone::soft);
  page.section("Hierarchy", "hierarchy");
  page.figure(
      icicle_html(p),
      "A row a level, the root on top; children share the width of their parent by unknowns. Rest the pointer on a "
      "sub-domain to read all of it.");
  page.section("Scene", "scene");
  page.figure(
      subdomains_html(p),
      "At the start; neighbours in colours that tell them apart. Circles are nodes of separators, the larger "
      "the nearer to the root. Lines with a head are the forces on the sub-domains of the level at the nodes of "
      "their interfaces at the last step, the longest drawn with 60 pixels; both sides of a cut are shown.");
  add_interfaces(page, p);
  if (const std::string timeline = timeline_svg(p); !timeline.empty()) {
    page.section("Timeline", "timeline");
    page.figure(timeline, "Some steps after the first ones; trace.json holds " + std::to_string(p.events.size()) +
                              " events, " + std::to_string(p.events_left_out) + " are left out.");
    std::string busy;
    for (std::size_t t = 0; t < p.thread_busy.size(); ++t)
      busy += (t > 0 ? ", " : "") + ("thread " + std::to_string(t)) + " " + seconds_text(p.thread_busy[t]);
    page.paragraph("Load balance " + io::rounded_text(p.load_balance, 3) + " (mean over most busy), " +
                   io::rounded_text(100.0 * p.efficiency, 3) +
                   " % of the threads' time in walks is work. Busy: " + busy + ".");
  }
  page.section("Where a step goes", "step");
  add_step(page, p);
  page.section("Levels", "levels");
  add_levels(page, p);
  page.section("Costliest sub-domains", "subdomains");
  add_costliest(page, p);
  add_speed(page, p);
  add_alternatives(page, p);
  page.section("Memory", "memory");
  page.table({{"solver", "factors", "element matrices", "whole program, peak"},
              {{{bytes_text(static_cast<double>(p.solver_bytes)), Tone::plain, true, "/memory/solver_bytes"},
                {bytes_text(static_cast<double>(p.factor_bytes)), Tone::plain, true, "/memory/factor_bytes"},
                {bytes_text(static_cast<double>(p.element_bytes)), Tone::plain, true, "/memory/element_bytes"},
                {bytes_text(static_cast<double>(p.peak_bytes)), Tone::plain, true, "/memory/peak_bytes"}}}});
  page.section("How to read the times", "notes");
  page.list(
      {"Times of sub-domains are medians over the walks of the run; in lockstep each takes an equal share of the "
       "visit. Evaluation is a mean.",
       "condense is the share of the elimination that updates the interface's own block, by flops; factor is the rest "
       "of the elimination.",
       "wait is from when the children of a sub-domain were factored until its own turn.",
       "condition is that of the scaled interface flexibility P^1/2 F P^1/2, F = (S + P)^-1. Interfaces above " +
           std::to_string(p.widest_condition) +
           " unknowns are left out. The form \"local\" computes neither F nor P: the condition says how well the "
           "interface can be solved by itself, and no digit of the solution depends on it."});
  return page.html();
}

}  // namespace bough::report
