// hsdm_figures FOLDER: draws the figures of the documentation from what the stages of the library return.

#include "figures.hh"

#include <exception>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

using namespace hsdm::figures;

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: hsdm_figures FOLDER\n";
        return 2;
    }
    const std::vector<std::pair<std::string, Canvas (*)()>> figures = {
        {"sheets-sets", draw_sets},
        {"sheets-relations", draw_relations},
        {"sheets-signs", draw_signs},
        {"sheets-crossings", draw_crossings},
        {"sheets-pairs", draw_pairs},
        {"sheets-thin", draw_thin_part},
        {"sheets-placing", draw_placing},
        {"sheets-border", draw_border},
        {"sheets-creases", draw_creases_outside},
        {"adaptive-leaves", draw_leaves},
        {"adaptive-clusters", draw_clusters},
        {"adaptive-patches", draw_patches},
        {"adaptive-collapses", draw_collapses},
        {"adaptive-flips", draw_flips},
        {"adaptive-bound", draw_error_bound},
        {"features-carried", draw_carried},
        {"features-classes", draw_classes},
        {"features-normals", draw_normals},
        {"features-decimated", draw_decimated},
        {"features-filled", draw_filled},
        {"features-smoothed", draw_smoothed},
        {"features-divided", draw_divided},
    };
    try {
        for (const auto& [name, draw] : figures) draw().save(std::string(argv[1]) + "/" + name + ".svg");
    } catch (const std::exception& error) {
        std::cerr << "hsdm_figures: " << error.what() << '\n';
        return 1;
    }
    return 0;
}
