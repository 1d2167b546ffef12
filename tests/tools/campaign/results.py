"""Checks of folders of results after kills and injected failures."""
import json
import pathlib
import shutil

from process import run

TINY = {
    "schema_version": 1, "title": "former", "gravity": [0, 0, -9.81],
    "bodies": [{"name": "bob", "kind": "point_mass", "mass": 1, "position": [1, 0, 0]}],
    "joints": [{"name": "hinge", "kind": "revolute", "first": "ground", "second": "bob", "position": [0, 0, 0],
                "axis": [0, 1, 0]}],
    "sensors": [{"name": "bob", "kind": "position", "at": "bob"}],
    "analysis": {"kind": "dynamic", "end_time": 0.2, "step_size": 0.01},
    "output": {"motion": True, "motion_stride": 4}}

STUDY = {
    "schema_version": 1, "scene": "new.json", "repetitions": 1,
    "quantities": [{"name": "place", "sensor": "bob"}],
    "reference": {"set": [{"pointer": "/analysis/step_size", "value": 2.5e-4}],
                  "check": [{"pointer": "/analysis/step_size", "value": 5e-4}], "order": 2},
    "grids": [{"name": "steps", "axes": [{"name": "step size", "values": [0.02, 0.01, 0.005]}],
               "orders": [{"quantity": "place", "order": 2, "theory": "second order"}]}]}


class Bench:
    """A folder with scenes and with good former results of each verb, from which every case starts."""

    def __init__(self, program, folder, end_time=0.2):
        self.program, self.folder = program, pathlib.Path(folder)
        self.template, self.place = self.folder / "template", self.folder / "place"
        self.template.mkdir()
        new = dict(TINY, title="new", analysis=dict(TINY["analysis"], end_time=end_time))
        (self.template / "former.json").write_text(json.dumps(TINY))
        (self.template / "new.json").write_text(json.dumps(new))
        (self.template / "study.json").write_text(json.dumps(STUDY))
        for name, scene in (("before", TINY), ("scenes", new)):
            (self.template / name).mkdir()
            for case in ("a", "b", "c"):
                (self.template / name / f"{case}.json").write_text(json.dumps(scene))
        for words in (["run", "former.json", "--out", "out"], ["view", "out"], ["batch", "before", "--out", "all"],
                      ["study", "study.json", "--out", "measured"]):
            result = run([self.program, *words], 60, cwd=self.template)
            if result.status != 0:
                raise RuntimeError(f"bough {' '.join(words)} fails: {result.err.decode(errors='replace')}")

    def commands(self):
        """Verbs that write, each with the folders that hold good results before and after."""
        return {
            "run": (["run", "new.json", "--out", "out", "--replace", "--quiet"], ["out"]),
            "batch": (["batch", "scenes", "--out", "all", "--replace", "--threads", "3", "--quiet"],
                      ["all/a", "all/b", "all/c"]),
            "study": (["study", "study.json", "--out", "measured", "--threads", "1", "--quiet"], ["measured"]),
            "view": (["view", "out"], ["out"]),
        }

    def start(self):
        """The folder of the next case, as the template."""
        shutil.rmtree(self.place, ignore_errors=True)
        shutil.copytree(self.template, self.place, symlinks=True)
        return self.place

    def faults(self, folders):
        """Faults of folders that had good results before: these or the new ones must be complete."""
        faults = []
        for name in folders:
            folder = self.place / name
            if name.startswith("all/") and not self.is_whole("all"):  # a batch keeps the former results until its end
                folder = self.place / name.replace("all/", "all.former/")
            faults += [f"{name}: {fault}" for fault in faults_of_files(folder)]
            if (self.template / name / "summary.json").exists():
                faults += self.faults_of_run(folder, name)
            elif (self.template / name / "study.json").exists() and not (folder / "study.json").exists():
                faults.append(f"{name}: the good results are gone")
        return faults

    def is_whole(self, name):
        try:
            return json.loads((self.place / name / "manifest.json").read_text())["state"] == "good"
        except (OSError, ValueError):
            return False

    def faults_of_run(self, folder, name):
        try:
            summary = json.loads((folder / "summary.json").read_text())
        except (OSError, ValueError) as error:
            return [f"{name}: the good results are gone: {error}"]
        result = run([self.program, "view", folder, "--out", self.folder / "page.html"], 60)
        faults = [] if result.status == 0 else [f"{name}: view refuses it: {result.err.decode(errors='replace')}"]
        if summary["status"] != "ok":
            faults.append(f"{name}: the good results were replaced by those of a run that is {summary['status']}")
        rows = len((folder / "history.csv").read_text().splitlines()) - 2
        if rows != summary["steps"]["accepted"]:
            faults.append(f"{name}: {rows} rows, {summary['steps']['accepted']} steps")
        return faults

    def faults_of_next(self, words, folders):
        """Runs the same command again, undisturbed: it must work, and leave no folder of a killed writer."""
        result = run([self.program, *words], 60, cwd=self.place)
        faults = self.faults(folders)
        if result.status != 0:
            faults.append(f"the next run ends with {result.status}: {result.err.decode(errors='replace').strip()}")
        faults += [f"left behind: {path.relative_to(self.place)}" for path in self.place.rglob(".*bough-new")]
        return faults


def faults_of_files(folder):
    """Faults of files: none may be incomplete under its final name."""
    faults = []
    for path in folder.rglob("*"):
        if not path.is_file() or path.name.endswith(".partial") or ".bough-new" in str(path):
            continue
        text = path.read_bytes()
        if path.suffix == ".json":
            try:
                json.loads(text)
            except ValueError:
                faults.append(f"{path.name} is cut")
        elif path.suffix == ".vtu" and not text.rstrip().endswith(b"</VTKFile>"):
            faults.append(f"{path.name} is cut")
        elif path.suffix == ".html" and b"</html>" not in text[-20:]:
            faults.append(f"{path.name} is cut")
        elif path.suffix in (".csv", ".jsonl", ".txt") and not text.endswith(b"\n"):
            faults.append(f"{path.name} ends within a line")
    return faults
