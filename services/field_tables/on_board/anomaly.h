
/* Takes an anomaly into one revolution, 0 to 2 pi: later revolutions use the table again. */
static inline double field_table_within(double behind_first_rad)
{
    const double turn = 6.283185307179586;
    double within = behind_first_rad;
    if (within < 0.0 || within > turn) {
        within = fmod(within, turn);
        if (within < 0.0) {
            within += turn;
        }
    }
    return within;
}

/* True anomaly behind the first, rad, of a position fix in ITRF (WGS-84, Earth-centred, any unit)
   taken so many seconds after the epoch (Liu 2019, eq. 3 and 4). */
static inline double field_table_anomaly_of_fix(const double position_itrf[3], double since_epoch_s)
{
    const double turned = FIELD_TABLE_EARTH_RATE_RAD_S * since_epoch_s;
    const double x = cos(turned) * position_itrf[0] - sin(turned) * position_itrf[1];
    const double y = sin(turned) * position_itrf[0] + cos(turned) * position_itrf[1];
    const double z = position_itrf[2];
    const double along = field_table_first[0] * x + field_table_first[1] * y + field_table_first[2] * z;
    const double ahead = field_table_ahead[0] * x + field_table_ahead[1] * y + field_table_ahead[2] * z;
    return field_table_within(atan2(ahead, along));
}

/* True anomaly behind the first, rad, so many seconds after the epoch, by the elements of the orbit
   (Liu 2019, eq. 5, where the orbit is a circle). */
static inline double field_table_anomaly_of_time(double since_epoch_s)
{
    const double pi = 3.141592653589793;
    const double e = FIELD_TABLE_ECCENTRICITY;
    const double mean =
        fmod(FIELD_TABLE_MEAN_ANOMALY_RAD + FIELD_TABLE_MEAN_MOTION_RAD_S * since_epoch_s, 2.0 * pi);
    const double side = sin(mean) < 0.0 ? -1.0 : 1.0;
    const double half = acos(fmax(-1.0, fmin(1.0, cos(mean))));
    double eccentric = fmin(half + e, pi);
    int step;
    for (step = 0; step < 50; ++step) {
        eccentric -= (eccentric - e * sin(eccentric) - half) / (1.0 - e * cos(eccentric));
    }
    return field_table_within(
        side * 2.0 * atan2(sqrt(1.0 + e) * sin(0.5 * eccentric), sqrt(1.0 - e) * cos(0.5 * eccentric)) -
        FIELD_TABLE_FIRST_ANOMALY_RAD);
}
