#pragma once
/// Job files that run all shards of a batch under engines of clusters.
#include <string>
#include <vector>

namespace bough::study {

enum class JobEngine { slurm, parallel, snakemake, kubernetes };

/// What the tasks of a job run.
struct JobSpec {
  std::string program;             ///< that is to be called; Kubernetes calls "bough" of its image instead
  std::vector<std::string> words;  ///< the verb and its options but for the shard
  std::string out;                 ///< folder of the results, absolute
  std::string folder;              ///< the same as it was given: where the job file goes
  std::string common_folder;       ///< that holds all that is read and written; of Kubernetes
  std::size_t count = 1;           ///< of shards
  int threads = 1;                 ///< of a task
  double memory_bytes = 0.0;       ///< that a task is predicted to take
};

struct JobFile {
  std::string name, text;
  std::string how_to_run;  ///< the command, in any folder but that of the results: engines write files where they run
};

/// Every task says literally which shard of how many it is, and goes on where an earlier one was stopped, so that a
/// part of a job can be run again. Throws std::runtime_error where a name cannot stand in such a file.
JobFile job_file(JobEngine engine, const JobSpec& spec);

/// A word as a POSIX shell takes it literally.
std::string shell_quoted(const std::string& word);

}  // namespace bough::study
