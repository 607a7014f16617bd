# Many scenes by Snakemake: a picture and a JSON report of each, and one table of all.
#   snakemake -s scripts/sweep.smk -j 4 --config scenes=FOLDER out=FOLDER [nuvo=PROGRAM flags="..."]
# What is there already and younger than its scene is not rendered again.
import csv
import json
import pathlib

SCENES = pathlib.Path(config["scenes"])
OUT = config["out"]
NUVO = config.get("nuvo", "build/native/nuvo")
FLAGS = config.get("flags", "--profile=fast --rep=1")
NAMES = sorted(path.stem for path in SCENES.glob("*.x3d"))


rule table:
    input:
        expand(OUT + "/{name}.json", name=NAMES),
    output:
        OUT + "/table.csv",
    run:
        columns = ["file", "shapes", "triangles", "build_seconds", "trace_seconds"]
        with open(output[0], "w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(columns)
            for path in input:
                report = json.loads(pathlib.Path(path).read_text())
                writer.writerow([report["file"], report["scene"]["shapes"], report["scene"]["triangles"],
                                 min(report["build_seconds"]), min(report["trace_seconds"])])


rule render:
    input:
        str(SCENES) + "/{name}.x3d",
    output:
        picture=OUT + "/{name}.png",
        report=OUT + "/{name}.json",
    shell:
        NUVO + " --file={input} " + FLAGS + " --quiet --out={output.picture} --json={output.report}"
