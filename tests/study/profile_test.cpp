/// Laws of a profile: sums over the tree, bounds of schedules, fits, files that can be read.
#include "bough/study/profile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <set>

#include "../../src/study/profile_cost.hpp"
#include "../../src/study/profile_parts.hpp"
#include "../../src/study/profile_run.hpp"
#include "../../src/study/profile_schedule.hpp"
#include "../../src/study/read_rate.hpp"
#include "../step/small_scenes.hpp"
#include "bough/io/json_value.hpp"
#include "bough/io/profile_json.hpp"
#include "bough/plan/plan.hpp"
#include "bough/scene/components.hpp"
#include "bough/study/tune.hpp"
#include "support/scenes.hpp"

namespace bough {
namespace {

using records::Profile;
using records::SubdomainProfile;
using study::Direction;

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

/// Rows as they come.
class Rows final : public records::Recorder {
 public:
  void begin(const records::HistoryHeader&) override {}
  void row(const records::HistoryRow& row) override { rows.push_back(row); }
  void motion(const records::MotionFrame&) override {}
  void end(const records::Summary&) override {}
  std::vector<records::HistoryRow> rows;
};

scene::Scene make_scene(int links, int leaf_size = 0) {
  scene::Scene s = test::make_chain(links);
  scene::Sensor sensor;
  sensor.name = "tip";
  sensor.kind = scene::SensorKind::position;
  sensor.at.to = "b" + std::to_string(links - 1);
  s.sensors.push_back(sensor);
  s.analysis.step_size = 1e-3;
  s.analysis.end_time = 0.01;
  s.solver.leaf_size = leaf_size;
  return s;
}

Profile profile_of(const scene::Scene& s, int threads = 1) {
  Rows nobody;
  return study::profile(s, {.threads = threads, .steps = 8, .steps_for_speed = 4}, nobody);
}

tree::Tree walk_of(const scene::Scene& s) {
  const plan::Plan plan = plan::make_plan(s);
  return tree::make_tree(plan.graph, {.leaf_size = s.solver.leaf_size});
}

TEST(ProfileSchedule, lies_between_the_bounds_of_any_schedule_and_never_grows) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.1, 2.0);
  for (int leaf_size : {1, 2, 5}) {
    const tree::Tree walk = walk_of(make_scene(24, leaf_size));
    std::vector<double> seconds(at(walk.num_subdomains()));
    double total = 0.0;
    for (double& s : seconds) total += s = uniform(random);
    const double path = study::critical_path(walk, seconds);
    EXPECT_LE(path, total);
    const std::vector<int> threads{1, 2, 3, 4, 8, 16, 64};
    for (Direction direction : {Direction::up, Direction::down}) {
      const std::vector<double> durations = study::eval_walks(walk, seconds, direction, threads, 0.0);
      EXPECT_NEAR(durations.front(), total, 1e-12 * total);
      for (std::size_t k = 0; k < threads.size(); ++k) {
        const double p = threads[k];
        EXPECT_GE(durations[k], std::max(path, total / p) * (1.0 - 1e-12));
        EXPECT_LE(durations[k], (total / p + (1.0 - 1.0 / p) * path) * (1.0 + 1e-12));  // Graham 1966
        EXPECT_LE(durations[k], durations[k > 0 ? k - 1 : 0]);
      }
      // So many threads that nobody waits for one.
      EXPECT_NEAR(study::eval_walk(walk, seconds, direction, 1000, 0.0), path, 1e-12 * path);
      // Everything below the grain: one task.
      EXPECT_NEAR(study::eval_walk(walk, seconds, direction, 64, 1e30), total, 1e-12 * total);
    }
  }
}

/// A root of 2 s over a leaf of 4 s and a sub-domain of 1 s, which has two leaves of 3 s and 2 s.
tree::Tree make_tree_by_hand() {
  tree::Tree t;
  const auto add = [&](int parent, std::vector<int> children, int subtree_begin) {
    tree::Subdomain s;
    s.parent = parent;
    s.subtree_begin = subtree_begin;
    s.child_begin = static_cast<std::int32_t>(t.subdomain_children.size());
    t.subdomain_children.insert(t.subdomain_children.end(), children.begin(), children.end());
    s.child_end = static_cast<std::int32_t>(t.subdomain_children.size());
    s.subtree_flops = 1.0 + static_cast<double>(t.subdomains.size()) - subtree_begin;
    t.subdomains.push_back(s);
  };
  add(4, {}, 0);
  add(3, {}, 1);
  add(3, {}, 2);
  add(4, {1, 2}, 1);
  add(tree::none, {0, 3}, 0);
  return t;
}

TEST(ProfileSchedule, of_a_tree_made_by_hand_takes_as_long_as_counted_on_paper) {
  const tree::Tree walk = make_tree_by_hand();
  const std::vector<double> seconds{4.0, 3.0, 2.0, 1.0, 2.0};
  EXPECT_DOUBLE_EQ(study::critical_path(walk, seconds), 6.0);
  const std::vector<int> threads{1, 2, 3, 8};
  // Up, two threads: the leaves of 4 s and 3 s, then that of 2 s until 5 s, its parent until 6 s, the root until 8 s.
  // Down, two threads: the root, then 4 s beside 1 s and 3 s until 6 s, then 2 s.
  for (Direction direction : {Direction::up, Direction::down})
    EXPECT_EQ(study::eval_walks(walk, seconds, direction, threads, 0.0), (std::vector<double>{12.0, 8.0, 6.0, 6.0}));
  // The sub-domain of three (3 flop) as one task of 6 s.
  EXPECT_EQ(study::eval_walks(walk, seconds, Direction::up, threads, 4.0), (std::vector<double>{12.0, 8.0, 8.0, 8.0}));

  const records::WalkProfile p =
      study::simulate_walk(walk, seconds, Direction::up, threads, 0.0, 70.0, {10.0, 14.0, 14.0, 14.0});
  EXPECT_DOUBLE_EQ(p.total, 12.0);
  EXPECT_DOUBLE_EQ(p.critical_path, 6.0);
  EXPECT_EQ(p.seconds, (std::vector<double>{12.0, 8.0, 6.0, 6.0}));
  EXPECT_EQ(p.memory_seconds, (std::vector<double>{7.0, 5.0, 5.0, 5.0}));
}

TEST(ProfileSchedule, idle_threads_share_the_loops_of_a_visit) {
  const tree::Tree walk = make_tree_by_hand();
  // 1.5 s of the root's 2 s can be divided into three parts. Everything else takes until 6 s on two threads (above) and
  // until 4 s on three.
  const study::VisitTimes times({4.0, 3.0, 2.0, 1.0, 2.0}, {0.0, 0.0, 0.0, 0.0, 1.5}, {1.0, 1.0, 1.0, 1.0, 3.0});
  EXPECT_DOUBLE_EQ(study::critical_path(walk, times), 5.0);
  EXPECT_EQ(study::eval_walks(walk, times, Direction::up, {1, 2, 3, 8}, 0.0),
            (std::vector<double>{12.0, 7.25, 5.0, 5.0}));
}

TEST(ReadRate, never_falls_with_threads_and_is_kept_beyond_those_of_the_machine) {
  for (std::size_t bytes : {std::size_t{0}, std::size_t{1} << 20}) {
    const std::vector<double> rates = study::measure_read_rates(bytes, {1, 2, 4, 8}, 2);
    ASSERT_EQ(rates.size(), 4u);
    EXPECT_GT(rates[0], 1e7);   // any machine reads ten megabytes in a second,
    EXPECT_LT(rates[1], 4e12);  // and no two processors four terabytes: the rounds are not optimised away
    EXPECT_GE(rates[1], rates[0]);
    EXPECT_EQ(rates[2], rates[1]);
    EXPECT_EQ(rates[3], rates[1]);
  }
}

TEST(ProfileCost, finds_costs_again_and_never_a_negative_one) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(1.0, 100.0);
  std::vector<solve::VisitShape> visits(60);
  std::vector<double> seconds;
  for (std::size_t v = 0; v < visits.size(); ++v) {
    visits[v].in_lanes = v % 2 == 0;
    visits[v].num_fronts = static_cast<int>(uniform(random));
    visits[v].flops = 1e3 * uniform(random);
    visits[v].factor_bytes = static_cast<std::int64_t>(1e3 * uniform(random));
    const double front = visits[v].in_lanes ? 1e-6 : 3e-6, flop = visits[v].in_lanes ? 1e-10 : 4e-10;
    seconds.push_back(front * visits[v].num_fronts + flop * visits[v].flops);
  }
  const auto costs = study::fit_costs(visits, seconds);
  ASSERT_EQ(costs.size(), 2u);
  for (const records::CostFit& c : costs) {
    EXPECT_EQ(c.num_visits, 30);
    EXPECT_NEAR(c.per_front, c.in_lanes ? 1e-6 : 3e-6, 1e-10);
    EXPECT_NEAR(c.per_flop, c.in_lanes ? 1e-10 : 4e-10, 1e-14);
    EXPECT_GE(c.per_byte, 0.0);
    EXPECT_LE(c.median_error, 1e-6);
  }
  const std::vector<double> again = study::predict(visits, costs);
  for (std::size_t v = 0; v < visits.size(); ++v) EXPECT_NEAR(again[v], seconds[v], 1e-6 * seconds[v]);
}

TEST(ProfileParts, entries_of_the_matrix_are_all_counted_once) {
  for (int leaf_size : {1, 4}) {
    const plan::Plan plan = plan::make_plan(make_scene(12, leaf_size));
    const tree::Tree tree = tree::make_tree(plan.graph, {.leaf_size = leaf_size});
    std::set<std::pair<int, int>> couples;
    for (int e = 0; e < plan.graph.num_elements(); ++e)
      for (auto i = plan.graph.element_begin[at(e)]; i < plan.graph.element_begin[at(e) + 1]; ++i)
        for (auto j = plan.graph.element_begin[at(e)]; j < plan.graph.element_begin[at(e) + 1]; ++j)
          couples.emplace(plan.graph.element_blocks[at(i)], plan.graph.element_blocks[at(j)]);
    std::int64_t expected = 0, found = 0;
    for (const auto& [a, b] : couples)
      expected += static_cast<std::int64_t>(plan.graph.block_size[at(a)]) * plan.graph.block_size[at(b)];
    for (std::int64_t n : study::count_matrix_entries(plan.graph, tree)) found += n;
    EXPECT_EQ(found, expected);
  }
}

TEST(Profile, forces_at_interfaces_are_those_of_sensors_by_their_paths) {
  scene::Scene s = make_scene(24, 3);
  s.sensors.clear();
  const tree::Tree tree = walk_of(s);
  Rows before;
  const Profile without = study::profile(s, {.threads = 1, .steps = 20, .steps_for_speed = 4}, before);
  ASSERT_GT(without.subdomains.size(), 6u);
  for (const SubdomainProfile& d : without.subdomains) {
    EXPECT_EQ(d.path.empty(), d.parent < 0);
    if (d.parent < 0) continue;
    for (const records::InterfaceNode& n : d.nodes) {
      s.sensors.emplace_back();
      s.sensors.back().name = "s" + std::to_string(s.sensors.size());
      s.sensors.back().kind = scene::SensorKind::interface_force;
      s.sensors.back().subdomain = d.path;
      s.sensors.back().at.to = n.name;
    }
  }
  Rows rows;
  const Profile p = study::profile(s, {.threads = 1, .steps = 20, .steps_for_speed = 4}, rows);
  ASSERT_EQ(p.steps, 10);
  ASSERT_EQ(rows.rows.back().values.size(), before.rows.back().values.size() + 6 * s.sensors.size());
  std::size_t k = 0;
  for (const SubdomainProfile& d : p.subdomains) {
    EXPECT_EQ(d.nodes.empty(), d.parent < 0);
    if (!d.nodes.empty()) EXPECT_GT(d.largest_force(), 0.0);
    for (const records::InterfaceNode& n : d.nodes) {
      const double* w = rows.rows.back().values.data() + 6 * k++;
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_DOUBLE_EQ(n.force[c], w[c]) << d.path << " " << n.name;
        EXPECT_DOUBLE_EQ(n.moment[c], w[3 + c]) << d.path << " " << n.name;
      }
    }
  }
}

TEST(Profile, sums_of_the_tree_agree) {
  for (int threads : {1, 2}) {
    const scene::Scene s = make_scene(80, 4);
    const Profile p = profile_of(s, threads);
    const tree::Tree tree = walk_of(s);
    ASSERT_EQ(p.subdomains.size(), at(tree.num_subdomains()));
    EXPECT_EQ(p.subdomains.back().subtree_unknowns, tree.num_unknowns());
    std::int64_t unknowns = 0;
    double seconds = 0.0, of_levels = 0.0, flops = 0.0;
    std::map<int, int> in_visit;
    for (const SubdomainProfile& d : p.subdomains) {
      unknowns += d.num_unknowns;
      seconds += d.times.solver();
      flops += d.flops;
      ++in_visit[d.visit];
      EXPECT_GE(d.fill, 0) << d.id;
      EXPECT_GT(d.times.factor, 0.0) << d.id;
      EXPECT_GE(d.times.assemble, 0.0);
      EXPECT_GE(d.times.condense, 0.0);
      EXPECT_GT(d.times.backward, 0.0);
      EXPECT_GE(d.thread, 0);
      EXPECT_LT(d.thread, threads);
      EXPECT_GE(d.parent >= 0 ? d.condition : 1.0, 1.0 - 1e-12);
    }
    for (const SubdomainProfile& d : p.subdomains) EXPECT_EQ(d.num_in_visit, in_visit[d.visit]);
    for (const records::LevelProfile& l : p.levels) of_levels += l.times.solver();
    EXPECT_EQ(unknowns, tree.num_unknowns());
    EXPECT_NEAR(p.subdomains.back().subtree_seconds, seconds, 1e-12 * seconds);
    EXPECT_NEAR(of_levels, seconds, 1e-12 * seconds);
    EXPECT_NEAR(p.subdomains.back().subtree_flops, flops, 1e-9 * flops);
    EXPECT_GT(p.num_in_lanes, 0);
    EXPECT_EQ(p.steps, 8);
    EXPECT_LE(p.critical_path, p.total * (1.0 + 1e-12));
    EXPECT_GT(p.critical_path, 0.0);
    ASSERT_EQ(p.speed.size(), 7u);
    for (std::size_t k = 1; k < p.speed.size(); ++k) {
      EXPECT_LE(p.speed[k].predicted, p.speed[k - 1].predicted);
      EXPECT_LE(p.speed[k].predicted_step, p.speed[k - 1].predicted_step);
      EXPECT_GE(p.speed[k].predicted, p.critical_path * (1.0 - 1e-12));
    }
    double of_walks = 0.0;
    for (const records::WalkProfile& w : p.walks) {
      of_walks += w.total;
      EXPECT_GT(w.bytes, 0.0) << w.work;
      EXPECT_EQ(w.seconds.size(), p.speed.size());
    }
    EXPECT_GE(p.walks.size(), 3u);
    EXPECT_NEAR(of_walks, p.total, 1e-12 * p.total);
    for (const records::ThreadsProfile& t : p.speed) EXPECT_GE(t.predicted_with_memory, t.predicted * (1.0 - 1e-12));
    EXPECT_GT(p.speed.front().measured, 0.0);
    EXPECT_GT(p.load_balance, 0.0);
    EXPECT_LE(p.load_balance, 1.0 + 1e-12);
    EXPECT_LE(p.efficiency, 1.0 + 1e-9);
    EXPECT_GT(p.alternatives.size(), 2u);
    EXPECT_TRUE(p.alternatives.front().is_present);
    EXPECT_FALSE(p.parts.empty());
    EXPECT_FALSE(p.events.empty());
  }
}

TEST(Profile, watches_all_of_the_first_16_steps_and_every_seventh_after_them) {
  scene::Scene statics = make_scene(4);  // tied to one cantilever
  for (scene::Joint& j : statics.joints) j.kind = scene::JointKind::fixed;
  statics.analysis.kind = scene::AnalysisKind::statics;
  statics.analysis.load_steps = 10;
  scene::Scene in_time = make_scene(4);
  in_time.analysis.end_time = 0.04;
  const auto watched = [](const scene::Scene& s) {
    study::NullRecorder nobody;
    const study::WatchedRun run = study::watch_run(s, {}, nobody, {});
    EXPECT_EQ(run.summary.status, records::RunStatus::ok) << run.summary.cause;
    return std::pair(run.steps.size(), run.watched.size());
  };
  EXPECT_EQ(watched(statics), (std::pair<std::size_t, std::size_t>(10, 10)));
  EXPECT_EQ(watched(in_time), (std::pair<std::size_t, std::size_t>(40, 16 + 3)));  // 21, 28, 35
}

TEST(Profile, files_are_json_and_hold_what_they_name) {
  Profile p = profile_of(make_scene(12, 2));
  p.scene = "a \"quoted\" name";
  std::vector<io::JsonFault> faults;
  const std::string profile_json = io::profile_text(p, "0.0");
  const auto profile = io::parse_json(profile_json, io::source_file, faults);
  ASSERT_TRUE(profile && faults.empty());
  EXPECT_EQ(profile->find("scene")->text, p.scene);
  EXPECT_EQ(profile->find("sub_domains")->items.size(), p.subdomains.size());
  const std::string trace_json = io::trace_text(p);
  const auto trace = io::parse_json(trace_json, io::source_file, faults);
  ASSERT_TRUE(trace && faults.empty());
  const io::JsonValue* events = trace->find("traceEvents");
  ASSERT_NE(events, nullptr);
  std::size_t complete = 0;
  double last = -1.0;
  for (const io::JsonValue& e : events->items) {
    ASSERT_NE(e.find("ph"), nullptr);
    ASSERT_NE(e.find("pid"), nullptr);
    if (e.find("ph")->text != "X") continue;
    ++complete;
    EXPECT_GE(e.find("dur")->number, 0.0);
    EXPECT_GE(e.find("ts")->number, 0.0);
    last = std::max(last, e.find("ts")->number);
  }
  EXPECT_EQ(complete, p.events.size());
  EXPECT_GT(last, 0.0);
}

TEST(Profile, a_run_that_fails_shows_what_ran) {
  scene::Scene s = make_scene(4);
  s.analysis.max_iterations = 1;
  s.analysis.max_cuts = 0;
  const Profile p = profile_of(s);
  EXPECT_FALSE(p.trouble.empty());
  EXPECT_FALSE(p.subdomains.empty());
  std::vector<io::JsonFault> faults;
  EXPECT_TRUE(io::parse_json(io::profile_text(p, "0"), io::source_file, faults) && faults.empty());
}

/// Forms whose walks visit no sub-domains have times of the step alone; all have interfaces with forces.
TEST(Profile, takes_every_form) {
  for (const scene::SolverForm form : {scene::SolverForm::augmented, scene::SolverForm::global,
                                       scene::SolverForm::hybrid, scene::SolverForm::monolithic}) {
    scene::Scene s = make_scene(16);
    s.solver.depth = 2;
    s.solver.form = form;
    const Profile p = profile_of(s);
    EXPECT_EQ(p.trouble, "") << scene::to_string(form);
    EXPECT_EQ(p.form, scene::to_string(form));
    EXPECT_GT(p.step.total, 0.0);
    ASSERT_EQ(p.levels.size(), 3u);
    double time_of_visits = 0.0;
    for (const records::SubdomainProfile& d : p.subdomains) {
      time_of_visits += d.times.solver();
      EXPECT_EQ(d.nodes.empty(), d.parent < 0);
    }
    EXPECT_EQ(time_of_visits > 0.0, form == scene::SolverForm::augmented) << scene::to_string(form);
    std::vector<io::JsonFault> faults;
    EXPECT_TRUE(io::parse_json(io::profile_text(p, "0"), io::source_file, faults) && faults.empty());
  }
}

/// The flexibilities that are drawn are the scaled ones whose singular values are told.
TEST(Profile, keeps_flexibilities_of_the_condition_that_it_tells) {
  scene::Scene s = make_scene(16);
  s.solver.depth = 2;
  for (const scene::SolverForm form : {scene::SolverForm::local, scene::SolverForm::augmented}) {
    s.solver.form = form;
    const Profile p = profile_of(s);
    int kept = 0;
    for (const records::SubdomainProfile& d : p.subdomains) {
      if (d.parent < 0) continue;
      ASSERT_FALSE(d.spectrum.empty());
      EXPECT_NEAR(d.spectrum.front() / d.spectrum.back(), d.condition, 1e-9 * d.condition);
      const std::size_t n = d.unknowns.size();
      if (n == 0) continue;
      ++kept;
      ASSERT_EQ(d.flexibility.size(), n * n);
      double squares = 0.0, of_spectrum = 0.0;  // of Frobenius
      for (const double f : d.flexibility) squares += f * f;
      for (const double f : d.spectrum) of_spectrum += f * f;
      EXPECT_NEAR(squares, of_spectrum, 1e-9 * squares);
    }
    EXPECT_GT(kept, 0);
  }
}

TEST(Tune, proposes_trees_that_differ_and_writes_a_block_that_reads_back) {
  const scene::Scene s = make_scene(16);
  const study::TuneResult r = study::tune(s, {.threads = 2, .steps = 3, .seconds = 0.0, .rounds = 3});
  ASSERT_GT(r.candidates.size(), 3u);
  EXPECT_EQ(r.rounds, 3);
  std::set<std::string> blocks;
  int present = 0;
  for (const study::TuneCandidate& c : r.candidates) {
    EXPECT_TRUE(blocks.insert(study::solver_block(c.solver)).second) << study::solver_block(c.solver);
    present += c.is_present ? 1 : 0;
    if (c.failure.empty()) {
      EXPECT_EQ(c.seconds.size(), 3u);
      EXPECT_LE(c.low, c.median);
      EXPECT_LE(c.median, c.high);
    }
  }
  EXPECT_EQ(present, 1);
  EXPECT_TRUE(r.candidates[r.present].is_present);
  EXPECT_TRUE(r.candidates[r.best].failure.empty());
  scene::Solver given;
  given.form = scene::SolverForm::hybrid;
  given.iterate_interface = true;
  given.leaf_size = 12;
  given.tasks = false;
  const scene::Scene read = support::gallery("pendulum", {"/solver=" + study::solver_block(given)});
  EXPECT_EQ(read.solver.form, given.form);
  EXPECT_EQ(read.solver.iterate_interface, given.iterate_interface);
  EXPECT_EQ(read.solver.leaf_size, given.leaf_size);
  EXPECT_EQ(read.solver.depth, given.depth);
  EXPECT_EQ(read.solver.tasks, given.tasks);
  given.form = scene::SolverForm::augmented;
  given.iterate_interface = false;
  given.penalty_factor = 0.1;
  EXPECT_EQ(support::gallery("pendulum", {"/solver=" + study::solver_block(given)}).solver.penalty_factor, 0.1);
}

TEST(Profile, does_not_change_a_bit_of_the_results) {
  for (int threads : {1, 3}) {
    scene::Scene s = make_scene(20);
    Rows alone, watched;
    run::SimulateOptions options;
    options.threads = threads;
    const records::Summary summary = run::simulate(s, options, alone);
    ASSERT_EQ(summary.status, records::RunStatus::ok) << summary.cause;
    const Profile p = study::profile(s, {.threads = threads, .steps = 1000, .steps_for_speed = 2}, watched);
    EXPECT_EQ(p.steps, summary.steps.accepted);
    ASSERT_EQ(alone.rows.size(), watched.rows.size());
    for (std::size_t k = 0; k < alone.rows.size(); ++k) {
      EXPECT_EQ(alone.rows[k].time, watched.rows[k].time);
      EXPECT_EQ(alone.rows[k].values, watched.rows[k].values) << k;  // bitwise
    }
  }
}

}  // namespace
}  // namespace bough
