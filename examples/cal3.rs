use frictcomp::circle::*;
fn main(){
    let plant = Preset::Stiff.plant();
    let test = CircularTest{circle:Circle{feed:2000.,..Circle::default()},model:FrictionModel::Lugre,list:plant_list(&plant.x),plant:plant.clone(),reading:Default::default()};
    for _ in 0..20 { let l=test.run(Job::ALL[2]).unwrap(); std::hint::black_box(l);}
}
