// What Python calls (`mesh_kernel.py`). It has made the tree, and checked every size.
//
// Nothing here takes memory but the stack, so nothing throws.

#include "../../../core/kernel/exports.h"
#include "closest.h"
#include "winding.h"

// To be raised with every change of what is below, or of a struct.
EXPORTED int32_t nisp_version() { return 1; }

// Of points (count, 3) the closest face and the squared distance from it.
EXPORTED void nisp_closest(const nisp::Tree* tree, const double* points, int64_t count, int32_t* faces,
                           double* squared) {
    for (int64_t i = 0; i < count; i++) {
        const nisp::Found found = nisp::ClosestTriangle(*tree, points + 3 * i).search();
        faces[i] = found.face;
        squared[i] = found.squared;
    }
}

// Of points (count, 3) whether they are inside, 1 or 0: by clusters from `rough` of their radii away,
// or from `exact` where the winding number is not `margin` away from 1/2.
EXPORTED void nisp_inside(const nisp::Tree* tree, const double* points, int64_t count, double rough,
                          double margin, double exact, uint8_t* inside) {
    for (int64_t i = 0; i < count; i++) {
        nisp::Winding winding(*tree, points + 3 * i);
        const double number = std::fabs(winding.about(rough));
        const bool clear = std::fabs(number - 0.5) >= margin;
        inside[i] = (clear ? number : std::fabs(winding.about(exact))) > 0.5;
    }
}

// Of points (count, 3) the winding number, each cluster as one from `radii` of its radii away.
EXPORTED void nisp_winding(const nisp::Tree* tree, const double* points, int64_t count, double radii,
                           double* numbers) {
    for (int64_t i = 0; i < count; i++) numbers[i] = nisp::Winding(*tree, points + 3 * i).about(radii);
}
