# Like threads.sh, with meshes of 100,000 triangles and more.
. "$here/threads.sh"
