
/* Takes a true anomaly behind the first, rad, into the table, 0 to 2 pi. Before the epoch the first
   row holds. In later revolutions the table is used again, although the Earth has turned (see
   above). */
static inline double field_table_within(double behind_first_rad) {
  const double turn = 6.283185307179586;
  if (behind_first_rad < 0.0) {
    return 0.0;
  }
  return behind_first_rad <= turn ? behind_first_rad : fmod(behind_first_rad, turn);
}

/* True anomaly behind the first, rad, so many seconds after the epoch, by the elements of the orbit
   (Liu 2019, eq. 5, where the orbit is a circle). It grows by 2 pi each revolution. */
static inline double field_table_anomaly_of_time(double since_epoch_s) {
  const double pi = 3.141592653589793;
  const double e = FIELD_TABLE_ECCENTRICITY;
  const double mean = FIELD_TABLE_MEAN_ANOMALY_RAD + FIELD_TABLE_MEAN_MOTION_RAD_S * since_epoch_s;
  const double turns = floor(mean / (2.0 * pi) + 0.5);
  const double left = mean - 2.0 * pi * turns;
  const double half = fabs(left);
  double eccentric = fmin(half + e, pi);
  double change = 1.0;
  double behind;
  int step;
  for (step = 0; step < 50 && fabs(change) > 1e-12; ++step) {
    change = (eccentric - e * sin(eccentric) - half) / (1.0 - e * cos(eccentric));
    eccentric -= change;
  }
  behind = 2.0 * atan2(sqrt(1.0 + e) * sin(0.5 * eccentric), sqrt(1.0 - e) * cos(0.5 * eccentric));
  return (left < 0.0 ? -behind : behind) + 2.0 * pi * turns - FIELD_TABLE_FIRST_ANOMALY_RAD;
}

/* True anomaly behind the first, rad, of a position fix in ITRF (WGS-84, Earth-centred, any unit)
   taken so many seconds after the epoch (Liu 2019, eq. 3 and 4). The time says in which revolution.
 */
static inline double field_table_anomaly_of_fix(const double position_itrf[3],
                                                double since_epoch_s) {
  const double turn = 6.283185307179586;
  const double turned = FIELD_TABLE_EARTH_RATE_RAD_S * since_epoch_s;
  const double x = cos(turned) * position_itrf[0] - sin(turned) * position_itrf[1];
  const double y = sin(turned) * position_itrf[0] + cos(turned) * position_itrf[1];
  const double z = position_itrf[2];
  const double along =
      field_table_first[0] * x + field_table_first[1] * y + field_table_first[2] * z;
  const double ahead =
      field_table_ahead[0] * x + field_table_ahead[1] * y + field_table_ahead[2] * z;
  const double behind = atan2(ahead, along);
  return behind + turn * floor((field_table_anomaly_of_time(since_epoch_s) - behind) / turn + 0.5);
}
