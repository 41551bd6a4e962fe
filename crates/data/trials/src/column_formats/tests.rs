#![allow(clippy::unwrap_used)]
use std::io::Cursor;

use hdf5_writer::{AttributeBuilder, DatasetBuilder, Hdf5Builder, WriteOptions};
use netcdf_writer::{NcAttrValue, NcFileBuilder, NcWriteOptions};

use super::ColumnFormat;
use crate::column_reader::ColumnFile;
use crate::findings::Findings;
use crate::limits::FileLimits;
use crate::mapping::Mapping;
use crate::table::Table;
use crate::testing::finding_messages;

/// Seconds since 1970 of 1 May 2024, 12:00.
const NOON: f64 = 1_714_564_800.0;

fn read_with(format: ColumnFormat, bytes: Vec<u8>, mapping: &Mapping) -> (Option<Table>, String) {
    let mut findings = Findings::default();
    let file = ColumnFile { format, input: Box::new(Cursor::new(bytes)) };
    let table = file.read_table(mapping, &mut findings);
    (table, finding_messages(findings))
}

fn read(format: ColumnFormat, bytes: Vec<u8>) -> (Table, String) {
    let (table, text) = read_with(format, bytes, &Mapping::with_canonical_names());
    (table.unwrap_or_else(|| panic!("{text}")), text)
}

fn column<'a>(table: &'a Table, header: &str) -> &'a [f64] {
    let at = table.columns.iter().position(|column| column.header == header);
    &table.values[at.unwrap_or_else(|| panic!("no {header}: {:?}", table.columns))]
}

fn with_unit(dataset: DatasetBuilder, unit: &str) -> DatasetBuilder {
    dataset.attribute(AttributeBuilder::fixed_string("units", unit))
}

fn hdf5_example() -> Vec<u8> {
    let psi = DatasetBuilder::typed_data("psi", vec![3], &[10_i16, 20, -9]).unwrap();
    let psi = with_unit(psi, "degrees_true")
        .attribute(AttributeBuilder::scalar("scale_factor", 0.5_f64).unwrap())
        .attribute(AttributeBuilder::scalar("_FillValue", -9_i16).unwrap());
    let time = DatasetBuilder::typed_data("time", vec![3], &[0.0_f64, 1.0, 2.0]).unwrap();
    let track = DatasetBuilder::typed_data("track", vec![3, 2], &[1_f32, 2., 3., 4., 5., 6.]);
    Hdf5Builder::new()
        .dataset(with_unit(time, "seconds since 2024-05-01 12:00:00"))
        .dataset(DatasetBuilder::typed_data("u_m_s", vec![3], &[1.0_f64, 2.0, 3.0]).unwrap())
        .dataset(psi)
        .dataset(track.unwrap().chunked(vec![2, 2]))
        .into_plan()
        .unwrap()
        .encode(WriteOptions::default())
        .unwrap()
}

fn mapping_of_track() -> Mapping {
    let mut mapping = Mapping::with_canonical_names();
    mapping.conventions.missing = sistership_model::manifest::MissingValues::Bridge;
    let column = |name: &str| sistership_model::manifest::ColumnMapping::new(name, "m");
    mapping.columns = vec![("y".into(), column("track(:,2)"))];
    mapping
}

#[test]
fn hdf5_gives_columns_with_units_scales_and_times() {
    let (table, text) = read_with(ColumnFormat::Hdf5, hdf5_example(), &mapping_of_track());
    let table = table.unwrap();
    assert_eq!(column(&table, "time"), [0.0, 1.0, 2.0], "{text}");
    assert_eq!(table.start.as_ref().unwrap().at_s, NOON);
    assert_eq!(column(&table, "u_m_s"), [1.0, 2.0, 3.0]);
    assert_eq!(column(&table, "track(:,2)"), [2.0, 4.0, 6.0]);
    let psi = column(&table, "psi");
    assert!((psi[1] - 10.0_f64.to_radians()).abs() < 1e-12 && psi[2].is_nan(), "{psi:?}");
}

#[test]
fn the_columns_of_matlab_are_the_rows_of_its_hdf5() {
    let values = [0.0_f64, 1.0, 2.0, 1.5, 2.5, 3.5];
    let plan = Hdf5Builder::new()
        .dataset(DatasetBuilder::typed_data("t_s", vec![1, 3], &[0.0_f64, 1.0, 2.0]).unwrap())
        .dataset(DatasetBuilder::typed_data("track", vec![2, 3], &values).unwrap())
        .into_plan();
    let mut body = plan.unwrap().encode(WriteOptions::default()).unwrap();
    // A superblock of version 2 behind MATLAB's 512 bytes: base address, checksum.
    body[12..20].copy_from_slice(&512_u64.to_le_bytes());
    let sum = hdf5_writer::jenkins_lookup3(&body[..44]);
    body[44..48].copy_from_slice(&sum.to_le_bytes());
    let mut bytes = format!("{:<512}", "MATLAB 7.3 MAT-file").into_bytes();
    bytes.extend(body);
    let (table, text) = read_with(ColumnFormat::Hdf5, bytes, &mapping_of_track());
    assert_eq!(column(&table.unwrap(), "track(:,2)"), [1.5, 2.5, 3.5], "{text}");
}

#[test]
fn netcdf_gives_variables_with_their_times() {
    let mut file = NcFileBuilder::new();
    let rows = file.add_dimension("row", 3).unwrap();
    let chars = |text: &str| NcAttrValue::Chars(text.into());
    let time = file.add_variable::<f64>("time", &[rows]).unwrap();
    file.add_variable_attribute(time, "units", chars("minutes since 2024-05-01 12:00:00")).unwrap();
    file.write_variable(time, &[0.0_f64, 1.0, 2.0]).unwrap();
    let speed = file.add_variable::<i16>("u", &[rows]).unwrap();
    file.add_variable_attribute(speed, "units", chars("m s-1")).unwrap();
    file.add_variable_attribute(speed, "scale_factor", NcAttrValue::Doubles(vec![0.01])).unwrap();
    file.write_variable(speed, &[100_i16, 200, 300]).unwrap();
    let bytes = file.to_vec(NcWriteOptions::classic()).unwrap().1;
    let (table, text) = read(ColumnFormat::NetCdf, bytes);
    assert_eq!(column(&table, "time"), [0.0, 60.0, 120.0], "{text}");
    assert_eq!(table.start.as_ref().unwrap().at_s, NOON);
    assert!((column(&table, "u")[2] - 3.0).abs() < 1e-9);
}

#[test]
fn a_track_of_gpx_gives_places_and_times() {
    let point = |k: usize| {
        format!(
            "<trkpt lat=\"{}\" lon=\"3.5\"><time>2024-05-01T12:00:{k:02}Z</time><extensions>\
             <s:speed>{k}.5</s:speed></extensions></trkpt>",
            51.0 + 1e-4 * k as f64
        )
    };
    let points: String = (0..5).map(point).collect();
    let text = format!(
        "<?xml version=\"1.0\"?><gpx><trk><name>a &amp; b</name><trkseg>{points}</trkseg></trk></gpx>"
    );
    let (table, text) = read(ColumnFormat::Gpx, text.into_bytes());
    assert_eq!(column(&table, "time"), [0.0, 1.0, 2.0, 3.0, 4.0], "{text}");
    assert_eq!(column(&table, "speed_m_s")[3], 3.5);
    assert!((column(&table, "latitude_deg")[4].to_degrees() - 51.0004).abs() < 1e-9);
    assert_eq!(table.start.as_ref().unwrap().at_s, NOON);
    let (none, text) = read_with(
        ColumnFormat::Gpx,
        b"<gpx><trkpt lat=\"1\"/></gpx>".to_vec(),
        &Mapping::default(),
    );
    assert!(none.is_none() && text.contains("GPX track cannot be read"), "{text}");
}

/// A log of NMEA 2000: rudder and heading each 0.1 s, a position as a fast packet of seven frames
/// each second.
fn nmea2000_log() -> String {
    use std::fmt::Write;
    let mut text = String::new();
    let mut line = |t: f64, identifier: u32, data: &[u8]| {
        let data: String = data.iter().map(|byte| format!("{byte:02X}")).collect();
        writeln!(text, "({t:.6}) can0 {identifier:08X}#{data}").unwrap();
    };
    for k in 0..50_u32 {
        let t = NOON + 0.1 * f64::from(k);
        let rudder = i16::try_from(k).unwrap() * 20;
        let [low, high] = rudder.to_le_bytes();
        // Two rudders: that to port, and its twin to starboard.
        line(t, 0x09F1_0D03, &[0, 0xff, 0xff, 0x7f, low, high, 0xff, 0xff]);
        line(t, 0x09F1_0D03, &[1, 0xff, 0xff, 0x7f, low, high, 0xff, 0xff]);
        let [low, high] = (10 * u16::try_from(k).unwrap()).to_le_bytes();
        line(t + 0.01, 0x09F1_1223, &[0, low, high, 0xff, 0x7f, 0xff, 0x7f, 0xfc]);
        if k % 10 == 0 {
            let mut message = [0; 43];
            message[7..15].copy_from_slice(&(510_000_000_000_000_000_i64).to_le_bytes());
            message[15..23].copy_from_slice(&(35_000_000_000_000_000_i64).to_le_bytes());
            let (first, rest) = message.split_at(6);
            line(t, 0x0DF8_0503, &[&[0_u8, 43][..], first].concat());
            for (frame, part) in rest.chunks(7).enumerate() {
                let head = u8::try_from(frame + 1).unwrap();
                line(t, 0x0DF8_0503, &[&[head][..], part].concat());
            }
        }
    }
    text
}

#[test]
fn frames_and_fast_packets_of_nmea_2000_become_columns_on_one_clock() {
    let (table, text) = read(ColumnFormat::Nmea2000, nmea2000_log().into_bytes());
    let rudder = column(&table, "delta_s_rad");
    assert!(rudder.len() > 30 && (rudder[20] - 0.0402).abs() < 1e-9, "{text}");
    assert_eq!(column(&table, "delta_p_rad")[20], rudder[20]);
    assert!((column(&table, "latitude_deg")[0].to_degrees() - 51.0).abs() < 1e-9);
    assert!((column(&table, "longitude_deg")[0].to_degrees() - 3.5).abs() < 1e-9);
    assert!((column(&table, "psi_rad")[20] - 0.02).abs() < 1e-9);
    // A frame is lost: its packet is not used.
    let lost: String = nmea2000_log()
        .lines()
        .filter(|line| !line.contains("#02"))
        .map(|line| format!("{line}\n"))
        .collect();
    let (table, _) = read(ColumnFormat::Nmea2000, lost.into_bytes());
    assert!(table.columns.iter().all(|column| column.header != "latitude_deg"));
}

/// Records of an MCAP log.
struct McapBytes(Vec<u8>);

impl McapBytes {
    fn record(&mut self, code: u8, content: &[u8]) {
        self.0.push(code);
        self.0.extend((content.len() as u64).to_le_bytes());
        self.0.extend(content);
    }

    fn text(text: &str) -> Vec<u8> {
        [&u32::try_from(text.len()).unwrap().to_le_bytes()[..], text.as_bytes()].concat()
    }

    fn schema(&mut self, id: u16, name: &str, encoding: &str, definition: &str) {
        let content = [
            id.to_le_bytes().to_vec(),
            Self::text(name),
            Self::text(encoding),
            Self::text(definition),
        ];
        self.record(3, &content.concat());
    }

    fn channel(&mut self, id: u16, schema: u16, topic: &str, encoding: &str) {
        let content = [
            id.to_le_bytes().to_vec(),
            schema.to_le_bytes().to_vec(),
            Self::text(topic),
            Self::text(encoding),
            vec![0; 4],
        ];
        self.record(4, &content.concat());
    }

    fn message(&mut self, channel: u16, t: f64, data: &[u8]) {
        let time = ((t * 1e9) as u64).to_le_bytes();
        let content = [&channel.to_le_bytes()[..], &[0; 4], &time, &time, data].concat();
        self.record(5, &content);
    }

    fn chunk(&mut self, packing: &str, unpacked: usize, packed: &[u8]) {
        let content = [
            vec![0; 16],
            (unpacked as u64).to_le_bytes().to_vec(),
            vec![0; 4],
            Self::text(packing),
            (packed.len() as u64).to_le_bytes().to_vec(),
            packed.to_vec(),
        ];
        self.record(6, &content.concat());
    }
}

/// An `Odometry` in CDR: header, child frame, pose and twist with covariances.
fn odometry(t: f64, numbers: [f64; 13]) -> Vec<u8> {
    let mut data = vec![0, 1, 0, 0];
    data.extend((t as i32).to_le_bytes());
    data.extend((((t - t.floor()) * 1e9) as u32).to_le_bytes());
    for frame in ["odom\0", "base_link\0"] {
        data.resize(4 + (data.len() - 4).next_multiple_of(4), 0);
        data.extend(McapBytes::text(frame));
    }
    data.resize(4 + (data.len() - 4).next_multiple_of(8), 0);
    for (at, number) in numbers.iter().enumerate() {
        data.extend(number.to_le_bytes());
        // Covariances follow the seven numbers of the pose, and the six of the twist.
        if at == 6 || at == 12 {
            data.extend([0; 36 * 8]);
        }
    }
    data
}

const ODOMETRY: &str = "std_msgs/Header header\nstring child_frame_id\n\
    geometry_msgs/PoseWithCovariance pose\ngeometry_msgs/TwistWithCovariance twist\n===\n\
    MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n===\n\
    MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n===\n\
    MSG: geometry_msgs/PoseWithCovariance\nPose pose\nfloat64[36] covariance\n===\n\
    MSG: geometry_msgs/Pose\nPoint position\nQuaternion orientation\n===\n\
    MSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n===\n\
    MSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n===\n\
    MSG: geometry_msgs/TwistWithCovariance\nTwist twist\nfloat64[36] covariance\n===\n\
    MSG: geometry_msgs/Twist\nVector3 linear\nVector3 angular\n===\n\
    MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n";

fn mcap_log(packing: &str) -> Vec<u8> {
    let mut inner = McapBytes(Vec::new());
    inner.schema(1, "nav_msgs/msg/Odometry", "ros2msg", ODOMETRY);
    inner.channel(1, 1, "/odometry", "cdr");
    inner.channel(2, 0, "/rudder_angle", "json");
    for k in 0..40 {
        let t = NOON + 0.1 * f64::from(k);
        // East with 2 m/s, turning to port by 0.1 rad/s as seen from above.
        let numbers =
            [0.2 * f64::from(k), 7.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 0.1, 0.0, 0.0, 0.0, 0.1];
        inner.message(1, t, &odometry(t, numbers));
        inner.message(2, t + 0.02, format!("{{\"data\": {}}}", f64::from(k) * 0.5).as_bytes());
    }
    let packed = match packing {
        "zstd" => zstd::stream::encode_all(&inner.0[..], 3).unwrap(),
        "lz4" => {
            let mut encoder = lz4_flex::frame::FrameEncoder::new(Vec::new());
            std::io::Write::write_all(&mut encoder, &inner.0).unwrap();
            encoder.finish().unwrap()
        }
        _ => inner.0.clone(),
    };
    let mut log = McapBytes(b"\x89MCAP0\r\n".to_vec());
    log.record(1, &[McapBytes::text("ros2"), McapBytes::text("")].concat());
    log.chunk(packing, inner.0.len(), &packed);
    log.record(0x0f, &[0; 4]);
    log.0
}

#[test]
fn messages_of_mcap_become_columns_in_any_packing() {
    for packing in ["", "zstd", "lz4"] {
        let (table, text) = read(ColumnFormat::Mcap, mcap_log(packing));
        assert_eq!(column(&table, "x_m")[0], 7.0, "{packing}: {text}");
        assert!((column(&table, "y_m")[10] - 2.2).abs() < 1e-6);
        assert!((column(&table, "psi_rad")[3] - std::f64::consts::FRAC_PI_2).abs() < 1e-9);
        assert_eq!(column(&table, "u_m_s")[1], 2.0);
        assert_eq!(column(&table, "v_m_s")[1], -0.1);
        assert_eq!(column(&table, "r_rad_s")[1], -0.1);
        assert!(text.contains("columns not read: rudder_angle"), "{text}");
    }
}

#[test]
fn bombs_and_damaged_files_are_errors_at_worst() {
    let mut mapping = Mapping::with_canonical_names();
    mapping.limits.unpacked_bytes = 12_000;
    let mut bomb = McapBytes(b"\x89MCAP0\r\n".to_vec());
    bomb.chunk("zstd", 1 << 30, &zstd::stream::encode_all(&[0; 10_000][..], 3).unwrap());
    let text = read_with(ColumnFormat::Mcap, bomb.0, &mapping).1;
    assert!(text.contains("more than is read"), "{text}");
    let wide = DatasetBuilder::typed_data("t_s", vec![2000], &[0.0_f64; 2000]).unwrap();
    let wide = wide.chunked(vec![2000]).filter(hdf5_writer::FilterDescription {
        id: hdf5_writer::FILTER_DEFLATE,
        name: None,
        client_data: vec![6],
    });
    let other = DatasetBuilder::typed_data("u_m_s", vec![2000], &[0.0_f64; 2000]).unwrap();
    let other = other.chunked(vec![2000]).filter(hdf5_writer::FilterDescription {
        id: hdf5_writer::FILTER_DEFLATE,
        name: None,
        client_data: vec![6],
    });
    let plan = Hdf5Builder::new().dataset(wide).dataset(other).into_plan().unwrap();
    let bytes = plan.encode(WriteOptions::default()).unwrap();
    assert!(bytes.len() < 12_000, "{}", bytes.len());
    let text = read_with(ColumnFormat::Hdf5, bytes, &mapping).1;
    assert!(text.contains("more numbers than are read"), "{text}");
    mapping.limits = FileLimits::default();
    for (format, bytes) in [
        (ColumnFormat::Hdf5, hdf5_example()),
        (ColumnFormat::Mcap, mcap_log("")),
        (ColumnFormat::Nmea2000, nmea2000_log().into_bytes()),
    ] {
        // A prime step, so that every kind of byte is met.
        for at in (0..bytes.len()).step_by(13) {
            let mut damaged = bytes.clone();
            damaged[at] ^= 0xff;
            let _ = read_with(format, damaged, &mapping);
        }
        for end in (0..bytes.len()).step_by(97) {
            let _ = read_with(format, bytes[..end].to_vec(), &mapping);
        }
    }
}
