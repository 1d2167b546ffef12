#pragma once
/// Profile of the tree of sub-domains of one scene: its sizes and its measured times. Plain data.
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace bough::records {

/// Seconds spent in one sub-domain, by kind of work; medians over the walks of a run. Sub-domains that are factored in
/// lockstep share the time of their visit equally.
struct SubdomainTimes {
  double evaluate = 0.0;  ///< its elements' residuals, in the walk that condenses them, or else with their tangents
  double assemble = 0.0;  ///< elements and children into fronts
  double factor = 0.0;    ///< elimination, less condense
  double condense = 0.0;  ///< updates of the interface's own block: the elimination's time by their share of its flops
  double forward = 0.0;   ///< right-hand side on the way up
  double backward = 0.0;  ///< solution on the way down
  double move = 0.0;      ///< its nodes moved, and the change of its elements measured
  double residual = 0.0;  ///< check of the solution
  double wait = 0.0;      ///< from the end of its children's factorization to its own start; not part of the sums
  /// One factorization and one solution, without the evaluation of elements and the motion of nodes.
  double solver() const { return assemble + factor + condense + forward + backward + residual; }
};

/// A node of an interface: its place, and what the rest of the structure exerts on the sub-domain there at the last
/// step, in the axes of the ground.
struct InterfaceNode {
  std::string name;
  double place[3] = {};
  double force[3] = {};   ///< [N]
  double moment[3] = {};  ///< about the node's origin [N m]
};

struct SubdomainProfile {
  int id = 0;
  int parent = -1;
  int level = 0;
  int visit = 0;         ///< number of the visit, which sub-domains factored in lockstep have in common
  int num_in_visit = 1;  ///< number of sub-domains in that visit
  bool is_leaf = true;
  int num_elements = 0;  ///< in the subtree
  int num_fronts = 0;
  int num_unknowns = 0;               ///< eliminated in this sub-domain
  std::int64_t subtree_unknowns = 0;  ///< including those of descendants
  int interface_unknowns = 0;         ///< on the boundary that is passed to the parent
  std::int64_t factor_entries = 0;    ///< of L and U: e^2 + 2 e b for each front
  std::int64_t fill = 0;              ///< those of the factor entries that are zero in the matrix itself
  double flops = 0.0;                 ///< of its own fronts [flop]
  double subtree_flops = 0.0;         ///< [flop]
  double bytes = 0.0;                 ///< factor and element matrices; its share of a visit in lockstep
  int thread = 0;                     ///< thread that visited it most often in the sampled walks
  SubdomainTimes times;               ///< of this sub-domain only
  double subtree_seconds = 0.0;       ///< SubdomainTimes::solver with descendants
  double condition =
      std::numeric_limits<double>::quiet_NaN();  ///< condition of the scaled flexibility of its interface; NaN: not
                                                 ///< computed
  std::string path;  ///< the child taken at each level from the root, "0.1", as sensors of interfaces name it
  std::vector<InterfaceNode> nodes;  ///< of its interface; empty for the root
  double largest_force() const;      ///< magnitude at a node of the interface [N]; NaN for the root
  double largest_moment() const;     ///< [N m]
  std::vector<double> spectrum;      ///< singular values of the scaled flexibility, descending; empty: not computed
  /// Of an interface that is examined: the scaled flexibility P^1/2 F P^1/2 by columns, and the owner and number
  /// of each unknown, as "'tip', 1".
  std::vector<double> flexibility;
  std::vector<std::string> unknowns;
};

struct LevelProfile {
  int level = 0;
  int num_subdomains = 0;
  std::int64_t num_unknowns = 0;
  int interface_unknowns_most = 0;
  std::int64_t fill = 0;
  double flops = 0.0, bytes = 0.0;
  SubdomainTimes times;  ///< sums over the sub-domains; wait: the largest
  double condition_most = std::numeric_limits<double>::quiet_NaN();
};

/// Time of one factorization and solution, and of one step, for a number of threads.
struct ThreadsProfile {
  int threads = 1;
  double predicted = 0.0;                                      ///< factorization and solution [s]
  double predicted_step = 0.0;                                 ///< [s]
  double measured = std::numeric_limits<double>::quiet_NaN();  ///< median [s]; NaN: more threads than the machine has
  double measured_step = std::numeric_limits<double>::quiet_NaN();
  /// Rate at which so many threads together read an array as large as all factors and element matrices [bytes/s]; for
  /// more threads than the machine has, that of all it has.
  double read_rate = std::numeric_limits<double>::quiet_NaN();
  /// Factorization and solution [s], each walk by its schedule or by its bytes at read_rate, whichever takes longer.
  double predicted_with_memory = std::numeric_limits<double>::quiet_NaN();
};

/// One kind of walk, simulated for the numbers of threads of Profile::speed.
struct WalkProfile {
  const char* work = "";        ///< "factor", "forward", "backward" or "residual"
  double total = 0.0;           ///< sum over all visits [s]
  double critical_path = 0.0;   ///< longest chain of visits that wait for each other [s]
  double bytes = 0.0;           ///< of factors and element matrices that it reads or writes; vectors are left out
  std::vector<double> seconds;  ///< schedule of its visits, by number of threads [s]
  std::vector<double> memory_seconds;  ///< bytes at the rate of so many threads [s]
};

/// Another tree for the same scene, with the time that the cost model predicts.
struct Alternative {
  int leaf_size = 0;  ///< option of the scene's solver block
  int depth = -1;
  bool is_present = false;  ///< this is the tree that was profiled
  int num_subdomains = 0, num_leaves = 0, num_levels = 0;
  double flops = 0.0;
  double predicted = 0.0;          ///< one factorization and solution on one thread [s]
  double predicted_threads = 0.0;  ///< on the threads of the profile [s]
};

/// Cost model of a visit: seconds = fronts * per_front + flops * per_flop + bytes * per_byte, fitted to the visits of
/// the run.
struct CostFit {
  bool in_lanes = false;
  int num_visits = 0;  ///< number of visits in the fit; 0: taken from the other kind
  double per_front = 0.0, per_flop = 0.0, per_byte = 0.0;
  double median_error = 0.0;  ///< median relative error of a visit
};

/// Mean times of one step of the run [s].
struct StepProfile {
  double total = 0.0;                                                                  ///< median
  double evaluate = 0.0, factor = 0.0, forward = 0.0, backward = 0.0, residual = 0.0;  ///< wall time
  double other_chunks = 0.0;  ///< wall time of other loops over elements and nodes
  double rest = 0.0;          ///< total minus all of these: serial work
  /// Numbers of walks per step: upward with and without a factorization, downward, of checks, of evaluations that
  /// condense nothing; and of all kinds.
  double factorizations = 0.0, condensations = 0.0, solutions = 0.0, checks = 0.0, evaluations = 0.0, walks = 0.0;
};

/// One timed visit, or one chunk of elements.
struct ProfileEvent {
  const char* work = "";  ///< "factor", "forward", "backward", "residual", "evaluate", "step" ...
  int visit = -1;         ///< -1: a chunk
  int item = 0;           ///< first item of a chunk; number of a step
  int thread = 0;
  double begin = 0.0, seconds = 0.0;  ///< [s] since the run began
};

/// One element of the structure, for a drawing.
struct ProfilePart {
  enum class Kind : std::uint8_t { beam, body, joint };
  Kind kind = Kind::beam;
  int leaf = 0;  ///< sub-domain
  std::vector<std::array<double, 3>> points;
};
/// A node that lies in a separator.
struct ProfileNode {
  std::array<double, 3> position{};
  int subdomain = 0;  ///< sub-domain that eliminates it
};

struct Profile {
  std::string scene, title, cut;  ///< cut: how the tree was made, in words
  std::string form;               ///< of the solver
  std::string trouble;            ///< if the run ended early: why
  int threads = 1, machine_threads = 1;
  long steps = 0, factorizations = 0, solutions = 0;
  bool is_dynamic = true;
  std::vector<SubdomainProfile> subdomains;  ///< postorder: children before parents, the root last
  std::vector<LevelProfile> levels;
  int num_visits = 0;
  int num_in_lanes = 0;  ///< number of sub-domains factored in lockstep
  StepProfile step;
  double total = 0.0;          ///< one factorization and solution: sum over all visits [s]
  double critical_path = 0.0;  ///< longest chain of visits that depend on each other [s]
  std::vector<ThreadsProfile> speed;
  std::vector<WalkProfile> walks;
  std::vector<double> thread_busy;  ///< seconds of the whole run spent in visits and chunks, by thread
  double load_balance = 1.0;        ///< mean busy time of the threads over the largest
  double efficiency = 1.0;          ///< busy time over (number of threads x wall time of walks and chunks)
  std::int64_t solver_bytes = 0, element_bytes = 0, factor_bytes = 0, peak_bytes = 0;
  std::vector<CostFit> costs;
  std::vector<Alternative> alternatives;  ///< the profiled tree first, then by predicted_threads
  std::vector<ProfilePart> parts;
  std::vector<ProfileNode> separator_nodes;
  std::vector<ProfileEvent> events;
  std::int64_t events_left_out = 0;
  int widest_condition = 0;  ///< for interfaces with more unknowns no condition is computed
};

/// Sums over the sub-domains of each level; the levels from the root down.
std::vector<LevelProfile> sum_levels(const std::vector<SubdomainProfile>& subdomains);
/// Fills subtree_seconds.
void sum_subtrees(std::vector<SubdomainProfile>& subdomains);

}  // namespace bough::records
