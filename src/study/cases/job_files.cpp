#include "bough/study/job_files.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bough/io/json_text.hpp"

namespace bough::study {
namespace {

/// Time before its time limit at which a queue tells a task to stop [s]. Running cases are abandoned, and the tables
/// are written.
constexpr int lead_seconds = 120;

std::string command_of(const JobSpec& spec) {
  std::string text = shell_quoted(spec.program);
  for (const std::string& word : spec.words) text += ' ' + shell_quoted(word);
  return text;
}

std::string collect_command(const JobSpec& spec) {
  return shell_quoted(spec.program) + " batch --collect " + shell_quoted(spec.out) + " --out " + shell_quoted(spec.out);
}

std::string path_of(const JobSpec& spec, const char* name) { return shell_quoted(spec.folder + "/" + name); }

std::string megabytes(double bytes) { return std::to_string(static_cast<long long>(std::ceil(1e-6 * bytes))); }

/// `exec` makes bough itself receive the queue's signal.
JobFile slurm_file(const JobSpec& spec) {
  const std::string count = std::to_string(spec.count);
  std::string text =
      "#!/bin/sh\n"
      "#SBATCH --job-name=bough\n"
      "#SBATCH --array=1-" +
      count +
      "\n"
      "#SBATCH --ntasks=1\n"
      "#SBATCH --cpus-per-task=" +
      std::to_string(spec.threads) +
      "\n"
      "#SBATCH --mem=" +
      megabytes(spec.memory_bytes) +
      "M\n"
      "# SIGTERM so long before the limit of time (--time) ends a shard with status 3; submitted again it goes on.\n"
      "#SBATCH --signal=B:TERM@" +
      std::to_string(lead_seconds) +
      "\n"
      "# All tasks or some of them, --array=7,12 say, can be submitted again: cases that are done do not run again.\n"
      "exec " +
      command_of(spec) + " --shard \"${SLURM_ARRAY_TASK_ID}/" + count + "\"\n";
  return {"job.slurm", std::move(text), "sbatch " + path_of(spec, "job.slurm")};
}

JobFile parallel_file(const JobSpec& spec) {
  std::string text;
  const std::string command = command_of(spec), count = std::to_string(spec.count);
  for (std::size_t i = 1; i <= spec.count; ++i) text += command + " --shard " + std::to_string(i) + "/" + count + "\n";
  return {"job.parallel", std::move(text), "parallel --joblog jobs.log < " + path_of(spec, "job.parallel")};
}

/// A list of words as Python has it: strings of JSON are strings of Python.
JobFile snakemake_file(const JobSpec& spec) {
  std::string text =
      "# Results are no outputs here, for Snakemake removes outputs of rules that fail: files of their own say what "
      "is\n"
      "# done. A shard with failed cases (status 1) is done; the last rule fails then, with all tables written.\n"
      "COMMANDS = [\n";
  const std::string command = command_of(spec), count = std::to_string(spec.count);
  for (std::size_t i = 1; i <= spec.count; ++i)
    text += "    " + io::json_string(command + " --shard " + std::to_string(i) + "/" + count) + ",\n";
  text += "]\nCOLLECT = " + io::json_string(collect_command(spec)) +
          "\n\n"
          "rule all:\n"
          "    input: \"bough.collected\"\n\n"
          "rule shard:\n"
          "    output: touch(\"bough.shard_{number}_of_" +
          count +
          "\")\n"
          "    threads: " +
          std::to_string(spec.threads) +
          "\n"
          "    params: command=lambda wildcards: COMMANDS[int(wildcards.number) - 1]\n"
          "    shell: \"{params.command} || test $? -eq 1\"\n\n"
          "rule collect:\n"
          "    input: expand(\"bough.shard_{number}_of_" +
          count + "\", number=range(1, " + count +
          " + 1))\n"
          "    output: touch(\"bough.collected\")\n"
          "    params: command=COLLECT\n"
          "    shell: \"{params.command}\"\n";
  return {"Snakefile", std::move(text), "snakemake --keep-going --cores all --snakefile " + path_of(spec, "Snakefile")};
}

/// $(NAME) would be replaced by Kubernetes, $$(NAME) stands for it.
std::string kubernetes_word(std::string word) {
  for (std::size_t at = 0; (at = word.find("$(", at)) != std::string::npos; at += 3) word.insert(at, 1, '$');
  return io::json_string(word);
}

JobFile kubernetes_file(const JobSpec& spec) {
  if (spec.common_folder.empty() || spec.common_folder == "/")
    throw std::runtime_error(
        "a job of Kubernetes mounts one folder that holds all that is read and written, and here only / does: put the "
        "scenes and --out into one folder");
  const std::string count = std::to_string(spec.count);
  std::string words = "\"bough\"";
  for (const std::string& word : spec.words) words += ", " + kubernetes_word(word);
  words += ", \"--shard\", \"auto/" + count + "\"";
  std::string text =
      "# Kubernetes 1.29 or later. To be changed: the image, which holds bough, and the claim, a volume that all pods\n"
      "# can write. Status 3 (told to stop) runs a shard again, 1 (a case failed) and 2 (bad input) do not, nor do "
      "they\n"
      "# end the other shards.\n"
      "apiVersion: batch/v1\n"
      "kind: Job\n"
      "metadata:\n"
      "  generateName: bough-\n"
      "spec:\n"
      "  completionMode: Indexed\n"
      "  completions: " +
      count +
      "\n"
      "  parallelism: " +
      std::to_string(std::min<std::size_t>(spec.count, 100)) +
      "\n"
      "  backoffLimitPerIndex: 10\n"
      "  podFailurePolicy:\n"
      "    rules:\n"
      "      - action: Ignore\n"
      "        onPodConditions: [{type: DisruptionTarget}]\n"
      "      - action: FailIndex\n"
      "        onExitCodes: {containerName: bough, operator: In, values: [1, 2]}\n"
      "  template:\n"
      "    spec:\n"
      "      restartPolicy: Never\n"
      "      terminationGracePeriodSeconds: " +
      std::to_string(lead_seconds) +
      "\n"
      "      containers:\n"
      "        - name: bough\n"
      "          image: bough:latest\n"
      "          command: [" +
      words +
      "]\n"
      "          resources: {requests: {cpu: \"" +
      std::to_string(spec.threads) + "\", memory: \"" + megabytes(spec.memory_bytes) +
      "M\"}}\n"
      "          volumeMounts: [{name: work, mountPath: " +
      io::json_string(spec.common_folder) +
      "}]\n"
      "      volumes:\n"
      "        - name: work\n"
      "          persistentVolumeClaim: {claimName: bough-work}\n";
  return {"job.yaml", std::move(text), "kubectl create -f " + path_of(spec, "job.yaml")};
}

}  // namespace

std::string shell_quoted(const std::string& word) {
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./=,:+@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

JobFile job_file(JobEngine engine, const JobSpec& spec) {
  for (const std::string* text : {&spec.program, &spec.out, &spec.common_folder})
    if (text->find_first_of("\n\r") != std::string::npos)
      throw std::runtime_error("a name with a line end cannot stand in a job file: " + *text);
  for (const std::string& word : spec.words)
    if (word.find_first_of("\n\r") != std::string::npos)
      throw std::runtime_error("a word with a line end cannot stand in a job file: " + word);
  switch (engine) {
    case JobEngine::slurm:
      return slurm_file(spec);
    case JobEngine::parallel:
      return parallel_file(spec);
    case JobEngine::snakemake:
      return snakemake_file(spec);
    case JobEngine::kubernetes:
      break;
  }
  return kubernetes_file(spec);
}

}  // namespace bough::study
