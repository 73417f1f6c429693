
/* Field in the orbit frame, nT: x along the motion, y against the orbit's normal, z to the Earth.
   The rows of the table are Chebyshev coefficients, added by Clenshaw's recursion. */
static inline void field_table_lookup(double behind_first_rad, double field_nt[3]) {
  const double x = field_table_within(behind_first_rad) / 3.141592653589793 - 1.0;
  int axis;
  for (axis = 0; axis < 3; ++axis) {
    double above = 0.0;
    double here = 0.0;
    int row;
    for (row = FIELD_TABLE_ROWS - 1; row > 0; --row) {
      const double next = (double)field_table_nt[row][axis] + 2.0 * x * here - above;
      above = here;
      here = next;
    }
    field_nt[axis] = (double)field_table_nt[0][axis] + x * here - above;
  }
}
