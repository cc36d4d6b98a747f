"""What NeuroM measures of a tracing, as JSON.

neurom_features.py FILE SHOLL_STEP SHOLL_COUNT
"""

import json
import sys

import neurom as nm
from neurom.features import bifurcation as bf
from neurom.features import section as sf


def of_section(section, center):
    forks = len(section.children) == 2
    return {
        "section_lengths": sf.section_length(section),
        "section_areas": sf.section_area(section),
        "section_volumes": sf.section_volume(section),
        "section_end_distances": sf.section_end_distance(section),
        "section_tortuosity": sf.section_tortuosity(section),
        "section_branch_orders": sf.branch_order(section),
        "section_strahler_orders": sf.strahler_order(section),
        "section_path_distances": sf.section_path_length(section),
        "section_radial_distances": sf.section_radial_distance(section, center),
        "local_bifurcation_angles": bf.local_bifurcation_angle(section) if forks else None,
        "remote_bifurcation_angles": bf.remote_bifurcation_angle(section) if forks else None,
        "partition_asymmetry": bf.partition_asymmetry(section) if forks else None,
    }


def statistics(what):
    names = [
        "number_of_sections",
        "number_of_bifurcations",
        "number_of_forking_points",
        "number_of_leaves",
        "total_length",
        "total_area",
        "total_volume",
        "max_radial_distance",
    ]
    numbers = {name: nm.get(name, what) for name in names}
    for name, mode in [
        ("section_branch_orders", max),
        ("section_strahler_orders", max),
        ("section_path_distances", max),
        ("section_lengths", mean),
        ("section_tortuosity", mean),
        ("local_bifurcation_angles", mean),
        ("remote_bifurcation_angles", mean),
        ("partition_asymmetry", mean),
    ]:
        numbers[f"{mode.__name__}_{name}"] = mode(nm.get(name, what))
    return numbers


def mean(values):
    return sum(values) / len(values) if len(values) else None


def main():
    file, step, count = sys.argv[1], float(sys.argv[2]), int(sys.argv[3])
    cell = nm.load_morphology(file)
    numbers = statistics(cell)
    for name in ["number_of_neurites", "total_width", "total_height", "total_depth"]:
        numbers[name] = nm.get(name, cell)
    for name in ["soma_radius", "soma_surface_area", "soma_volume"]:
        numbers[name] = nm.get(name, cell)
    radii = [step * k for k in range(1, count + 1)]
    numbers["sholl_crossings"] = nm.get("sholl_crossings", cell, radii=radii)
    sections = [s for neurite in cell.neurites for s in neurite.root_node.ipreorder()]
    document = {
        "cell": numbers,
        "neurites": [statistics(neurite) for neurite in cell.neurites],
        "sections": [of_section(section, cell.soma.center) for section in sections],
    }
    print(json.dumps(document, default=float))


main()
