/* What stands where in an HDF5 file of a mesh, for those who write one and those who read it; docs/formats.md tells it
 * to users.
 *
 *     /points              [n][2] float64
 *     /point_markers       [n]    int32                       unless markers are left out
 *     /point_attributes    [n][any] float64                   where there are any
 *     /triangles           [m][3] int32, or int64 where a number of a point does not fit
 *     /triangle_attributes [m][any] int32 where all are whole numbers that fit, else float64; where there are any
 *     /segments            [s][2] as /triangles
 *     /segment_markers     [s]    int32                       unless markers are left out
 *     /about               its attributes say what the file holds
 *
 * Beside them stand views for programs that look elsewhere (triangle/hdf5/views.h). Numbers count from 0 and lie in
 * memory's order, little-endian. */
#ifndef TRIANGLE_HDF5_LAYOUT_H
#define TRIANGLE_HDF5_LAYOUT_H

#define TRI_H5_POINTS "points"
#define TRI_H5_POINT_MARKERS "point_markers"
#define TRI_H5_POINT_ATTRIBUTES "point_attributes"
#define TRI_H5_TRIANGLES "triangles"
#define TRI_H5_TRIANGLE_ATTRIBUTES "triangle_attributes"
#define TRI_H5_SEGMENTS "segments"
#define TRI_H5_SEGMENT_MARKERS "segment_markers"

#define TRI_H5_ABOUT "about"
#define TRI_H5_ABOUT_VERSION "version"          /* int64, of the format */
#define TRI_H5_ABOUT_INPUT_POINTS "input_points" /* the first so many were there before refinement */

enum { TRI_H5_VERSION = 1 };

#endif
