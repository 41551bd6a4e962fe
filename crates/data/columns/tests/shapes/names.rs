//! Headers as recorders and people write them, one row a quantity. They were collected apart from
//! the vocabulary of the crate.

use sistership_columns::Role;

/// A way of writing headers.
pub struct Naming {
    pub name: &'static str,
    pub headers: &'static [(Role, &'static str)],
}

macro_rules! naming {
    ($name:literal, $($role:ident $header:literal),* $(,)?) => {
        Naming { name: $name, headers: &[$((Role::$role, $header)),*] }
    };
}

/// Ten ways: nine languages and abbreviations.
pub const NAMINGS: [Naming; 10] = [
    naming!("English", Time "Elapsed time", X "North position", Y "East position", Psi "Heading",
        U "Surge velocity", V "Sway velocity", R "Rate of turn", Phi "Heel angle", P "Roll rate",
        Delta "Rudder angle", DeltaS "Rudder angle stbd", DeltaP "Rudder angle port",
        N "Propeller RPM", Latitude "GPS latitude", Longitude "GPS longitude",
        Speed "Speed over ground", Course "Course over ground", VNorth "North velocity",
        VEast "East velocity"),
    naming!("German", Time "Zeit", X "Position Nord", Y "Position Ost", Psi "Kreiselkurs",
        U "Längsgeschwindigkeit", V "Quergeschwindigkeit", R "Drehrate", Phi "Krängung",
        P "Rollrate", Delta "Ruderlage", DeltaS "Ruderlage Stb", DeltaP "Ruderlage Bb",
        N "Drehzahl Propeller", Latitude "Breite", Longitude "Länge", Speed "Fahrt über Grund",
        Course "Kurs über Grund", VNorth "Geschwindigkeit Nord", VEast "Geschwindigkeit Ost"),
    naming!("Norwegian", Time "Tid", X "Nord", Y "Øst", Psi "Kurs", U "Langskips fart",
        V "Tverrskips fart", R "Svingehastighet", Phi "Krengevinkel", P "Rullrate",
        Delta "Rorvinkel", DeltaS "Rorvinkel styrbord", DeltaP "Rorvinkel babord", N "Turtall",
        Latitude "Breddegrad", Longitude "Lengdegrad", Speed "Fart over grunn",
        Course "Kurs over grunn", VNorth "Fart nord", VEast "Fart øst"),
    naming!("French", Time "Temps", X "Position nord", Y "Position est", Psi "Cap",
        U "Vitesse longitudinale", V "Vitesse transversale", R "Vitesse de lacet", Phi "Gîte",
        P "Vitesse de roulis", Delta "Angle de barre", DeltaS "Angle de barre tribord",
        DeltaP "Angle de barre bâbord", N "Régime hélice", Latitude "Latitude",
        Longitude "Longitude", Speed "Vitesse fond", Course "Route fond", VNorth "Vitesse nord",
        VEast "Vitesse est"),
    naming!("Spanish", Time "Tiempo", X "Posición norte", Y "Posición este", Psi "Rumbo",
        U "Velocidad longitudinal", V "Velocidad transversal", R "Velocidad de guiñada",
        Phi "Escora", P "Velocidad de balance", Delta "Ángulo de timón",
        DeltaS "Timón estribor", DeltaP "Timón babor", N "Revoluciones hélice",
        Latitude "Latitud", Longitude "Longitud", Speed "Velocidad sobre el fondo",
        Course "Rumbo sobre el fondo", VNorth "Velocidad norte", VEast "Velocidad este"),
    naming!("Italian", Time "Tempo", X "Posizione nord", Y "Posizione est", Psi "Angolo di prua",
        U "Velocità longitudinale", V "Velocità trasversale", R "Velocità di imbardata",
        Phi "Sbandamento", P "Velocità di rollio", Delta "Angolo di timone",
        DeltaS "Timone dritta", DeltaP "Timone sinistra", N "Giri elica", Latitude "Latitudine",
        Longitude "Longitudine", Speed "Velocità sul fondo", Course "Rotta sul fondo",
        VNorth "Velocità nord", VEast "Velocità est"),
    naming!("Japanese", Time "時刻", X "北方向位置", Y "東方向位置", Psi "船首方位",
        U "前後速度", V "左右速度", R "回頭角速度", Phi "横揺れ角", P "横揺れ角速度",
        Delta "舵角", DeltaS "右舷舵角", DeltaP "左舷舵角", N "プロペラ回転数",
        Latitude "緯度", Longitude "経度", Speed "対地速度", Course "対地針路",
        VNorth "北方向速度", VEast "東方向速度"),
    naming!("Korean", Time "시간", X "북방향위치", Y "동방향위치", Psi "선수각", U "전후속도",
        V "횡속도", R "선회각속도", Phi "횡동요각", P "횡동요각속도", Delta "타각",
        DeltaS "우현 타각", DeltaP "좌현 타각", N "프로펠러 회전수", Latitude "위도",
        Longitude "경도", Speed "대지속도", Course "대지침로", VNorth "북방향속도",
        VEast "동방향속도"),
    naming!("Chinese", Time "时间", X "北向位置", Y "东向位置", Psi "艏向角", U "纵向速度",
        V "横向速度", R "艏摇角速度", Phi "横摇角", P "横摇角速度", Delta "舵角",
        DeltaS "右舷舵角", DeltaP "左舷舵角", N "螺旋桨转速", Latitude "纬度",
        Longitude "经度", Speed "对地航速", Course "对地航向", VNorth "北向速度",
        VEast "东向速度"),
    naming!("abbreviations", Time "t", X "N", Y "E", Psi "hdg", U "u", V "v", R "ROT", Phi "roll",
        P "p", Delta "rud", DeltaS "rud_s", DeltaP "rud_p", N "rpm", Latitude "lat",
        Longitude "lon", Speed "SOG", Course "COG", VNorth "vel_n", VEast "vel_e"),
];
