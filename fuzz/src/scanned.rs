//! Requirements on points of a part, and inputs to begin with.

use armill_formats::measurement::scan::{Scan, ScanReadOptions, read};

use crate::verdicts::refused;

/// Rows, tables and QIF.
pub fn scan(bytes: &[u8]) {
    check("part.csv", bytes);
}

/// PLY with and without faces.
pub fn surface(bytes: &[u8]) {
    check("part.ply", bytes);
}

/// DMIS.
pub fn dmis(bytes: &[u8]) {
    check("part.dmis", bytes);
}

/// What is read has finite points, and as many of everything else or nothing.
fn check(name: &str, bytes: &[u8]) {
    let found = match read(name, bytes, &ScanReadOptions::default()) {
        Err(problems) => {
            refused(&problems);
            return;
        }
        Ok(found) => found,
    };
    let Scan { points, normals, nominal, deviations, names, .. } = found;
    assert!(points.iter().all(|p| p.coords.iter().all(|x| x.abs() <= 1e4)));
    assert!(normals.iter().flatten().all(|normal| (normal.norm() - 1.0).abs() < 1e-9));
    for count in [normals.len(), nominal.len(), deviations.len(), names.len()] {
        assert!(count == 0 || count == points.len());
    }
}

/// Points in rows, tables and QIF.
pub fn scans() -> Vec<Vec<u8>> {
    texts(&[
        "# scan\n1 -2.5 3 0 0.6 0.8\n4 5 6 0 0 1\n",
        "2\n1,0 -2,5 3 255\n4 5 6 0\n",
        "//X Y Z Intensity\n1 -2.5 3 7\n4 5 6 7\n",
        "name,x_mm,y_mm,z_mm,nx,ny,nz,nom_x_mm,nom_y_mm,nom_z_mm,dev_um\nP1,1,-2.5,3,0,0,1,1,-2.5,2.99,10\nP2,4,5,6,0,0,1,,,,\n",
        "X [um];label;Y [um];Z [um]\n1000;P1;-2500;3000\n",
        "<QIFDocument><LinearUnit><UnitConversion><Factor>0.001</Factor></UnitConversion></LinearUnit>\
         <PointFeatureNominal id='3'><Location>1 2 3</Location><Normal>0 0 1</Normal></PointFeatureNominal>\
         <PointFeatureItem id='4'><FeatureNominalId>3</FeatureNominalId><FeatureName>P</FeatureName></PointFeatureItem>\
         <PointFeatureActual id='5'><FeatureItemId>4</FeatureItemId><Location>1 2 3.1</Location></PointFeatureActual></QIFDocument>",
    ])
}

/// Point clouds and a mesh.
pub fn surfaces() -> Vec<Vec<u8>> {
    const HEAD: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    texts(&[
        &format!("{HEAD}end_header\n0 0 0\n1 0 0\n0 1 0\n"),
        &format!("{HEAD}property float nx\nproperty float ny\nproperty float nz\nend_header\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n"),
        &format!("{HEAD}element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
    ])
}

/// DMIS output.
pub fn reports() -> Vec<Vec<u8>> {
    texts(&[
        "$$ report\nDMISMN/'out',05.0\nUNITS/MM,ANGDEC\nF(P1)=FEAT/POINT,CART,1,-2.5,2.99,0,0,1\nFA(P1)=FEAT/POINT,CART,1.0,-2.5,$\n 3.0,0,0,1\n\
         PTDATA/CART,4,5,6\nFA(C1)=FEAT/CIRCLE,INNER,CART,10,20,0,0,0,1,8.5\nFA(PL)=FEAT/PLANE,CART,0,0,1,0,0,1\nENDFIL\n",
        "UNITS/INCH,ANGDEC\nMEAS/POINT,F(P),1\nPTMEAS/CART,1,0,0,0,0,1\nENDMES\n",
    ])
}

fn texts(texts: &[&str]) -> Vec<Vec<u8>> {
    texts.iter().map(|text| text.as_bytes().to_vec()).collect()
}
